#pragma once

#include "job/job.h"
#include "surface/surface.h"

namespace fettle::plan {

/// Checks that the wheel can grind this surface inside B (Wang 2007, 3.4). Its radius must not exceed the radius of a
/// concave section in its plane. On a surface with the radius of curvature R along its axis, the sag over its width,
/// width²/8R, must be within the tolerance; R is that of the arc over the width.
/// @throws InputError if not, with the position and the two values; also if the surface is not defined inside B
void check_wheel_fits(const job::Job& job, const surface::Surface& surface);

} // namespace fettle::plan
