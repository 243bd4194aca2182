#include "fit/robust_spline.h"

#include "fit/dense_start.h"
#include "geometry/quantiles.h"
#include "surface/spline_energy.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMinPasses = 3;
constexpr int kMaxPasses = 10;
constexpr double kChangeToleranceSigmas = 0.1; // rms change of the surface in a pass: far below a point's noise

/// Partial sums and buffers of one lane of blocks.
struct Lane {
    std::optional<CellMoments> moments; ///< allocated with the first points, by the thread that fills it
    std::size_t outliers = 0;
    PointCounts counts;
    std::vector<CellPoint> points;
    std::vector<double> r, w;
};

void set_biweights(Lane& lane, double cutoff)
{
    for (std::size_t i = 0; i < lane.points.size(); ++i) {
        const double t = lane.r[i] / cutoff;
        const double root = std::max(1 - t * t, 0.0);
        lane.w[i] = root * root;
        lane.outliers += root == 0;
    }
}

/// Heights of a spline at the middles of its cells.
MatrixXd middle_heights(const surface::Bspline& spline)
{
    const std::vector<double> polynomials = cell_polynomials(spline);
    MatrixXd heights(spline.heights.rows() - 3, spline.heights.cols() - 3);
    constexpr std::size_t kCoefficients = 16; // of a cell's polynomial, the constant first
    for (Index k = 0; k < heights.size(); ++k) heights.data()[k] = polynomials[kCoefficients * k];
    return heights;
}

/// Reads all points and weighs their residuals. @param spline  includes the trend
SplinePass read_points(const DensePoints& points, const surface::Bspline& spline, double sigma)
{
    const std::vector<double> polynomials = cell_polynomials(spline);
    std::vector<Lane> lanes(kNumLanes);
    parallel_for_blocks(points.source, [&](std::size_t k, std::size_t, const cloud::PointBlock& block) {
        Lane& lane = lanes[k];
        assign_cells(points, block, lane.points, lane.counts);
        lane.r.resize(lane.points.size());
        lane.w.resize(lane.points.size());
        residuals(lane.points, polynomials, lane.r.data());
        set_biweights(lane, geometry::kTukeyCutoff * sigma);
        if (!lane.moments) lane.moments.emplace(points.grid);
        lane.moments->add(lane.points, lane.r.data(), lane.w.data());
    });
    for (std::size_t k = 1; k < kNumLanes; ++k) {
        if (lanes[k].moments) lanes[0].moments->add(*lanes[k].moments);
        lanes[0].outliers += lanes[k].outliers;
    }
    const CellMoments sum = std::move(*lanes[0].moments);
    const std::size_t outliers = lanes[0].outliers;
    lanes.clear(); // frees their memory before the matrix is allocated
    const MatrixXd s = density_factors(sum.weights());
    const MatrixXd weights = s.cwiseProduct(sum.weights());
    return {{sum.normal_matrix(points.grid, s), sum.right_side(s), sum.square_sum(s), weights.sum(),
             rounding_variance(points) * weights.sum()},
            weights,
            middle_heights(spline) + sum.mean_residuals(),
            outliers};
}

surface::Bspline plus(surface::Bspline spline, const VectorXd& heights)
{
    spline.heights += heights.reshaped(spline.heights.rows(), spline.heights.cols());
    return spline;
}

/// Iterates to convergence or kMaxPasses.
void iterate(const DensePoints& points, RobustSpline& state)
{
    for (;;) {
        state.last = read_points(points, state.with_trend(), state.sigma);
        ++state.passes;
        const VectorXd heights = state.spline.heights.reshaped();
        const SmoothedSpline fit =
            state.passes < kMinPasses
                ? smooth_spline(state.last.equations, heights, state.energy, state.lambda)
                : smooth_spline_by_likelihood(state.last.equations, heights, state.energy, state.lambda);
        state.spline.heights = fit.heights.reshaped(state.spline.heights.rows(), state.spline.heights.cols());
        state.lambda = fit.lambda;
        state.sigma = std::sqrt(std::max(fit.variance / kBiweightVariance, rounding_variance(points)));
        state.change = fit.change;
        if ((state.passes >= kMinPasses && state.converged()) || state.passes == kMaxPasses) return;
    }
}

} // namespace

bool RobustSpline::converged() const { return change <= kChangeToleranceSigmas * sigma; }

surface::Bspline RobustSpline::with_trend() const { return plus(spline, trend); }

surface::Bspline RobustSpline::trend_alone() const
{
    surface::Bspline zero = spline;
    zero.heights.setZero();
    return plus(std::move(zero), trend);
}

RobustSpline fit_robust_spline(const DensePoints& points, const std::string& name)
{
    DenseStart start = estimate_dense_start(points, name);
    SplinePass none{{surface::zero_band_matrix(points.grid), {}, 0, 0, 0}, {}, {}, 0};
    RobustSpline state{std::move(start.spline),
                       surface::quadratic_control_heights(points.grid).heights * start.trend,
                       start.sigma,
                       start.lambda,
                       0,
                       0,
                       start.counts,
                       std::move(none),
                       spline_energy_matrix(points.grid)};
    iterate(points, state);
    return state;
}

} // namespace fettle::fit
