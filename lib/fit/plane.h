#pragma once

#include "fit/fit.h"

namespace fettle {

/// Plane by total least squares: through the centroid, along the smallest singular vector (Wang 2007, eq. 4-2, has no
/// plane through the origin). Touches further off than the probe's accuracy weigh less (Huber). Uses role 0, too.
/// @throws InputError for fewer than 3 touches, touches (nearly) on a line, or a vertical plane
Fit fit_plane(const FitInput& input);

} // namespace fettle
