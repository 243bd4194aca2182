#include "fit/dense.h"

#include "fit/bspline.h"
#include "fit/dense_start.h"
#include "fit/smoothing.h"
#include "geometry/bounding_box.h"
#include "geometry/quantiles.h"
#include "surface/precision.h"
#include "surface/spline_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// E[w x²] / E[w] of normal errors x of variance 1, with the weights w of Tukey's biweight (Holland and Welsch 1977).
constexpr double kBiweightVariance = 0.8280730;

constexpr int kMinPasses = 3;
constexpr int kMaxPasses = 10;
constexpr double kChangeToleranceSigmas = 0.1; // rms change of the surface in a pass: far below a point's noise

/// What one pass over all points gives.
struct Pass {
    NormalEquations equations;
    MatrixXd weights; ///< Σ s w of each cell
    std::size_t outliers = 0;
};

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

/// Reads all points and weighs their residuals. @param spline  includes the trend
Pass read_points(const DensePoints& points, const surface::Bspline& spline, double sigma)
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
            outliers};
}

/// The iterate of the re-weighted fit.
struct State {
    surface::Bspline spline; ///< without the trend
    VectorXd trend;          ///< control heights
    double sigma = 0;        ///< standard deviation of a point, mm
    double lambda = 0;
    double change = 0; ///< rms change of the surface in the last pass, mm
    int passes = 0;

    bool converged() const { return change <= kChangeToleranceSigmas * sigma; }
    surface::Bspline with_trend() const
    {
        surface::Bspline sum = spline;
        sum.heights += trend.reshaped(sum.heights.rows(), sum.heights.cols());
        return sum;
    }
};

/// Iterates to convergence or kMaxPasses. @return  the last pass, whose λ maximises the likelihood
Pass iterate(const DensePoints& points, const SplineEnergy& energy, State& state)
{
    for (;;) {
        Pass pass = read_points(points, state.with_trend(), state.sigma);
        ++state.passes;
        const VectorXd heights = state.spline.heights.reshaped();
        const SmoothedSpline fit = state.passes < kMinPasses
                                       ? smooth_spline(pass.equations, heights, energy, state.lambda)
                                       : smooth_spline_by_likelihood(pass.equations, heights, energy, state.lambda);
        state.spline.heights = fit.heights.reshaped(state.spline.heights.rows(), state.spline.heights.cols());
        state.lambda = fit.lambda;
        state.sigma = std::sqrt(std::max(fit.variance / kBiweightVariance, rounding_variance(points)));
        state.change = fit.change;
        if ((state.passes >= kMinPasses && state.converged()) || state.passes == kMaxPasses) return pass;
    }
}

/// Centres of cells with points, about `spacing` apart (M): in each square of that side, the cell nearest to its
/// centre.
Eigen::Matrix2Xd subsample_cells(const surface::Bspline& grid, const MatrixXd& weights, double spacing)
{
    std::map<std::pair<Index, Index>, std::pair<double, Vector2d>> nearest;
    for (Index column = 0; column < weights.cols(); ++column)
        for (Index row = 0; row < weights.rows(); ++row) {
            if (weights(row, column) == 0) continue;
            const Vector2d uv(row + 0.5, column + 0.5);
            const Vector2d square = (uv.cwiseProduct(grid.cell) / spacing).array().floor();
            const double distance =
                (uv.cwiseProduct(grid.cell) - (square + Vector2d::Constant(0.5)) * spacing).squaredNorm();
            const auto [at, added] =
                nearest.try_emplace({static_cast<Index>(square.x()), static_cast<Index>(square.y())}, distance, uv);
            constexpr double kTieFactor = 1 - 1e-9; // rounding must not break ties
            if (!added && distance < kTieFactor * at->second.first) at->second = {distance, uv};
        }
    Eigen::Matrix2Xd xy(2, nearest.size());
    Index k = 0;
    for (const auto& [square, found] : nearest) xy.col(k++) = machine_from_grid(grid, found.second);
    return xy;
}

/// Cells from subsample_cells(), half of B apart unless that gives too few or too many. M
Eigen::Matrix2Xd condensed_places(const surface::Bspline& grid, const MatrixXd& weights, const job::Job& job)
{
    constexpr Index kMinPlaces = 24;  // the parameters of a quadratic, and three times as many for its residuals
    constexpr Index kMaxPlaces = 100; // the exact posterior of so many takes a few tens of milliseconds
    const Eigen::Matrix2Xd anomaly = job::rotation_working_machine(job.theta) * job.anomaly.topRows<2>();
    double spacing = geometry::bounding_box(anomaly).sizes().maxCoeff() / 2;
    Eigen::Matrix2Xd xy = subsample_cells(grid, weights, spacing);
    while (xy.cols() > kMaxPlaces) xy = subsample_cells(grid, weights, spacing *= std::numbers::sqrt2);
    while (xy.cols() < kMinPlaces && spacing > grid.cell.minCoeff())
        xy = subsample_cells(grid, weights, spacing /= std::numbers::sqrt2);
    return xy;
}

/// Sets the condensed touches and the precision of the posterior.
void set_posterior(surface::Surface& surface, const DensePoints& points, const Pass& pass, const SplineEnergy& energy,
                   const State& state, const job::Job& job)
{
    const surface::Bspline& spline = std::get<surface::Bspline>(surface.shape);
    const Eigen::Matrix2Xd xy = condensed_places(points.grid, pass.weights, job);
    surface.touches.resize(3, xy.cols());
    surface.touches << xy, surface::heights(surface, xy).transpose();
    surface.roles = Eigen::VectorXi::Ones(xy.cols());

    // The variance is bounded from below by the λ at which rounding would swallow the energy that bridges gaps; for so
    // exact points the precision is smaller than theirs.
    const double fine_amplitude = std::sqrt(kBiweightVariance) * state.sigma / std::sqrt(state.lambda);
    surface::SplinePrecision precision{pass.weights / (state.sigma * state.sigma), fine_amplitude};
    FitInput condensed;
    condensed.xyz = surface.touches;
    condensed.roles = surface.roles;
    condensed.job = job;
    const double touch = std::sqrt(surface::sigmas(spline, precision, xy).squaredNorm() / xy.cols());
    precision.amplitude = std::max(fine_amplitude, estimate_field_amplitude(condensed, touch));
    const double variance = std::max(state.sigma * state.sigma,
                                     min_lambda(pass.equations, energy) * precision.amplitude * precision.amplitude);
    precision.weights = pass.weights / variance;
    for (std::size_t k = 0; k < points.cells.size(); ++k)
        if (points.cells[k] == DensePoints::edge_of_anomaly || points.cells[k] == DensePoints::edge_of_both)
            precision.weights.data()[k] = 0;
    surface.precision = std::move(precision);
}

} // namespace

bool can_fit_dense(const job::Job& job, const std::string& method)
{
    return method == "bspline" || (method == "auto" && job.surface == job::SurfaceType::freeform);
}

DenseFit fit_dense(const cloud::PointSource& source, const job::Job& job, bool use_boundary, const std::string& name)
{
    const DensePoints points = dense_points(source, job, use_boundary, name);
    State state;
    DenseFit result;
    {
        DenseStart start = estimate_dense_start(points, name);
        result.counts = start.counts;
        state.trend = surface::quadratic_control_heights(points.grid).heights * start.trend;
        state.spline = std::move(start.spline);
        state.sigma = start.sigma;
        state.lambda = start.lambda;
    }
    const SplineEnergy energy = spline_energy_matrix(points.grid);
    const Pass pass = iterate(points, energy, state);
    result.outliers = pass.outliers;
    result.fit.converged = state.converged();
    result.fit.iterations = state.passes;
    surface::Surface& surface = result.fit.surface;
    surface.units = job.units;
    surface.method = "bspline";
    surface.shape = state.with_trend();
    surface.touch_sigma = state.sigma;
    surface.rms = std::sqrt(pass.equations.square_sum / pass.equations.weight_sum);
    surface.goodness = std::numeric_limits<double>::quiet_NaN();
    surface.ignored = static_cast<int>(std::min<std::size_t>(result.counts.ignored(), std::numeric_limits<int>::max()));
    set_posterior(surface, points, pass, energy, state, job);
    return result;
}

} // namespace fettle::fit
