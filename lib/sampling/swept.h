#pragma once

#include "sampling/touch_plan.h"

namespace fettle::sampling {

/// Touch plan of a straight swept surface (Wang 2007, 4.4.2 and 4.4.4, 2). Three touches on the ruling line: the ends
/// and the middle of the longest interval along the rulings in S \ B. Four touches on the section curve:
///   (a) if a line is free over the whole width of the anomaly, four uniform points over exactly that width;
///   (b) if lines are free over a part of it, the ends of the two intervals that together cover its largest part;
///   (c) otherwise the longest line across, at its crossings with S and B.
/// Where Wang's choice is arbitrary, it is the line closest to the anomaly, then the one with the smallest coordinate.
/// @throws InputError if there is no such line; the message asks for another sampling boundary
TouchPlan plan_swept(const job::Job& job);

} // namespace fettle::sampling
