#pragma once

#include "fit/fit.h"

namespace fettle {

/// Wang's modified griddata (2007, 4.3, fig. 4-6) through samples and estimated points (roles 1 to 5). The uniform
/// sampling is spaced input.spacing, or half the mean distance of neighbouring points: shorter waves than that distance
/// are not in the points.
///
/// The covariance is that of the touches. An estimated point has no error of its own, it follows the touches of its two
/// lines (input.curves); without them it counts as a touch.
/// @throws InputError for fewer than 3 points, or all on a line
Fit fit_griddata(const FitInput& input);

} // namespace fettle
