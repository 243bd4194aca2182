#pragma once

#include "fit/fit.h"

namespace fettle::fit {

/// Plane by total least squares: it contains the centroid, and its normal is the smallest singular vector (Wang 2007,
/// eq. 4-2, has no plane through the origin). Residuals beyond the probe's accuracy get Huber's weights. Points of role
/// 0 are used, too.
/// @throws InputError for fewer than 3 touches, touches (nearly) on a line, or a vertical plane
Fit fit_plane(const FitInput& input);

} // namespace fettle::fit
