#pragma once

#include "fit/fit.h"

namespace fettle {

/// Sphere by robust least squares of the orthogonal distances, convex or concave, in the curvature parameters of
/// Lukács, Martin and Marshall (1998): a flat piece gives curvature 0, not a radius without bounds.
/// @throws InputError for fewer than 4 touches, or touches that do not determine a sphere (on one line or circle)
Fit fit_sphere(const FitInput& input);

} // namespace fettle
