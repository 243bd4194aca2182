#pragma once

#include "fit/fit.h"

namespace fettle {

/// Cylinder by robust least squares of the orthogonal distances, convex or concave, any axis that is not upright, in
/// the curvature parameters of Lukács, Martin and Marshall (1998). The best of several starting directions.
/// @throws InputError for fewer than 5 touches, or touches that do not determine a cylinder
Fit fit_cylinder(const FitInput& input);

} // namespace fettle
