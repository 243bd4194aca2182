#pragma once

#include "sampling/touch_plan.h"

namespace fettle {

/// Straight swept surface (Wang 2007, 4.4.2 and 4.4.4, 2). Three touches on the ruling line: both ends and the middle
/// of the longest stretch along the rulings in S \ B. Four on the section curve, across the rulings:
///   (a) a line is free over the whole width of the anomaly: four uniform points over exactly that width;
///   (b) lines are free over a part of it: the ends of the two stretches that together cover most of it;
///   (c) no line is: the longest line across, where it crosses S and B.
/// Where Wang leaves the choice to chance, the line nearest to the anomaly is taken; then that with the smallest
/// coordinate.
/// @throws InputError if there is neither, asking for another sampling boundary
TouchPlan plan_swept(const Job& job);

} // namespace fettle
