#pragma once

#include "fit/fit.h"

namespace fettle::fit {

/// Wang's modified tensor B-spline (2007, 4.3; TensorBsplineSystem) through samples and estimated points (roles 1 to
/// 5), for parity with Table 4-1: every touch is taken as exact. The covariance propagates the touches' errors, the
/// estimated points depending on them as in fit_griddata(); model errors are not in it.
/// @throws InputError for fewer than 4 different points, too many, or points on a line
Fit fit_bspline_wang(const FitInput& input);

} // namespace fettle::fit
