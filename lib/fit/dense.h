#pragma once

#include "fit/dense_points.h"
#include "fit/fit.h"

namespace fettle::fit {

/// Largest number of touches for the exact posterior of fit_bspline(), whose cost grows with their cube: it takes a
/// quarter of a second for 300, ten seconds for 1200.
inline constexpr std::size_t kMaxExactTouches = 300;

/// A fit to very many points.
struct DenseFit {
    Fit fit;                ///< its touches are condensed: heights of the fit, not points
    double point_sigma = 0; ///< standard deviation of a point, mm
    PointCounts counts;
    std::size_t outliers = 0;       ///< used points of weight 0
    std::size_t dropped_groups = 0; ///< Representatives::dropped
};

/// The fit of fit_bspline() for scans of any size. The points are read block by block, five times or a few times more,
/// and not kept in memory. It minimises
///     Σ_cells s Σ_points w (z - f)² + λ E(f)
/// over tensor-product cubic splines f on up to 64 x 64 cells. E is the energy of the third derivatives
/// (spline_energy.h), and λ maximises the marginal likelihood (smoothing.h). s evens out the points' density. w are
/// Tukey's biweights (Beaton and Tukey 1974) of the residuals of the previous pass, those of the first pass of a fit of
/// least absolute deviations (dense_start.h), so that points far from the majority of their neighbours are ignored. The
/// standard deviation of a point comes from the residuals, not from the job's probe.
///
/// Chosen by place, the points inside the anomaly B and those outside the sampling boundary S are left out, and the
/// surface of least energy bridges B. Its uncertainty there is estimated from points that lie half of B
/// apart: their amplitude τ (estimate_field_amplitude) goes into the precision, unless the finer points' own is larger.
/// Cells that B's edge crosses count as empty in it.
/// @param name  of the points in messages
/// @throws InputError for fewer than 6 points, points on a line or a conic section in x and y, none outside B
DenseFit fit_dense(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                   const std::string& name);

/// PointCounts::ignored() as the `ignored` of a surface.
int ignored_count(const PointCounts& counts);

} // namespace fettle::fit
