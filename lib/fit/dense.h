#pragma once

#include "fit/dense_points.h"
#include "fit/fit.h"

namespace fettle {

/// More touches than this are too many for the exact posterior of fit_bspline(), whose cost goes with their cube: it
/// takes a quarter of a second for 300, ten seconds for 1200.
inline constexpr std::size_t kMostExactTouches = 300;

/// Are they streamed? More touches than the exact fit takes, for a method that does without it.
bool is_dense(const PointSource& source, const Job& job, const std::string& method);

/// A fit to very many points.
struct DenseFit {
    Fit fit; ///< its touches are condensed: heights of the fit, not points; it has no residuals
    PointCounts counts;
    std::size_t outliers = 0; ///< used points that weigh nothing
};

/// As fit_bspline(), for scans of any size. The points are read block by block, five times or a few times more, and not
/// kept. It minimises
///     Σ_cells s Σ_points w (z - f)² + λ E(f)
/// over tensor-product cubic splines f on up to 64 x 64 cells. E is the energy of the third derivatives
/// (spline_energy.h) and λ that of the largest marginal likelihood (smoothing.h). s evens out the points' density. w
/// are Tukey's biweights (Beaton and Tukey 1974) of the residuals of the pass before, first of a fit of least absolute
/// deviations (dense_start.h), so that what is far from the greater part of its neighbours has no say. The standard
/// deviation of a point comes from the residuals, not from the job's probe.
///
/// Without roles the points are a scan: those inside the anomaly B and those outside the sampling boundary S are left
/// out. Under B the least energy bridges. What the surface may do there is told by points that lie half of B apart:
/// their amplitude τ (field_amplitude) goes into the precision, unless the finer points' own is larger. Cells that B's
/// edge crosses are taken for empty in it.
/// @param name  of the points in messages
/// @throws InputError for fewer than 6 points, points on a line or a conic section in x and y, none outside B
DenseFit fit_dense(const PointSource& source, const Job& job, bool use_boundary, const std::string& name);

} // namespace fettle
