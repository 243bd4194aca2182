#pragma once

#include "fit/fit.h"

#include <Eigen/Geometry>

namespace fettle::fit {

/// The default for free-form surfaces: a tensor-product cubic B-spline height field on a grid aligned with W that
/// covers B and the touches. It minimises, with Ceres,
///     Σ ρ((z_i - f(x_i, y_i)) / σ)  +  E(g) / τ²  +  |D²q|² / κ²  +  (c - 1)² / s²,    f = q + c p + g
/// σ is the touch's standard deviation, ρ Huber's loss with the width of the probe's accuracy. q is a quadratic, p
/// turns it into a round surface (round_part.h), g is the remainder, E its third-derivative energy (spline_prior.h), τ
/// the amplitude of g estimated from the touches (evidence.h). Outliers are left out of the sum; the goodness of fit
/// still counts them. κ is the curvature of the touched surface, but at least that of slopes that change by 1 over the
/// touched length; it matters only for what the touches leave undetermined, such as the twist between two crossing
/// lines. Quadratics, spheres and cylinders are reproduced when the touches are exact. The covariance is that of the
/// control heights given the touches.
/// More than kMaxExactTouches (dense.h) take long: use fit_dense() for those.
/// @throws InputError for fewer than 6 touches, or touches on a line
Fit fit_bspline(const FitInput& input);

/// The grid of fit_bspline(): it covers B and the touches with a border of one cell; its heights are 0.
surface::Bspline spline_grid(const FitInput& input, const Eigen::Matrix3Xd& touches);

/// A grid of about square cells with all heights 0.
/// @param box  the rectangle to cover, W, mm   @param cells  along the rectangle's longer side
/// @param border  cells to add on each side   @param angle  from X_m to X_w, rad
surface::Bspline make_spline_grid(const Eigen::AlignedBox2d& box, double cells, double border, double angle);

/// Numbers of cells of a grid along u and v.
Eigen::Array2d cell_counts(const surface::Bspline& grid);

/// A grid over the same rectangle with other numbers of cells; its heights are 0.
surface::Bspline with_cell_counts(const surface::Bspline& grid, const Eigen::Array2d& counts);

/// The amplitude τ of fit_bspline() for touches without outliers, 1/mm. @param sigma  of a touch, mm
double estimate_field_amplitude(const FitInput& input, double sigma);

} // namespace fettle::fit
