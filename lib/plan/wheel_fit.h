#pragma once

#include "job/job.h"
#include "surface/surface.h"

namespace fettle {

/// Can the wheel grind this surface inside B (Wang 2007, 3.4)? Its radius must not exceed the radius of a hollow in its
/// plane, and on a surface that is curved along its axis, radius R, its edges may stand off (or in) by the tolerance at
/// most: width²/8R.
/// @throws InputError if not, with the place and the two values; also if the surface is not defined inside B
void check_wheel_fits(const Job& job, const Surface& surface);

} // namespace fettle
