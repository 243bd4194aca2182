#pragma once

#include "fit/fit.h"

namespace fettle {

/// Wang's modified tensor B-spline (2007, 4.3; TensorBsplineSystem) through samples and estimated points (roles 1 to
/// 5), for parity with Table 4-1: it takes every touch as exact. The covariance is that of the touches, which the
/// estimated points follow as in fit_griddata; what the surface cannot follow is not in it.
/// @throws InputError for fewer than 4 different points, too many, or points on a line
Fit fit_bspline_wang(const FitInput& input);

} // namespace fettle
