#pragma once

#include "fit/fit.h"

namespace fettle::fit {

/// Wang's modified griddata (2007, 4.3, fig. 4-6) through samples and estimated points (roles 1 to 5). The uniform
/// sampling has the spacing input.spacing, or half the mean distance of neighbouring points, since the points do not
/// resolve shorter waves.
///
/// The points {s_i} of the job's sampling boundary that have a z are touches, too: the operator measured them on good
/// metal (4.4.4, 3), and B is inside their hull, while corners of B lie outside the hull of the touches on the lines.
///
/// Touches of the anomaly's boundary (input.use_boundary) that are closer to another touch than the spacing and the
/// wheel's width are averaged with it; the points of the shape are these means.
///
/// The covariance is that of the touches. An estimated point has no error of its own but depends on the touches of its
/// two lines (input.curves); without the lines it counts as a touch.
/// @throws InputError for fewer than 3 points, or all on a line
Fit fit_griddata(const FitInput& touched);

} // namespace fettle::fit
