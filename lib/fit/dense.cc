#include "fit/dense.h"

#include "fit/bspline.h"
#include "fit/dense_start.h"
#include "fit/smoothing.h"
#include "surface/precision.h"
#include "surface/spline_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Tukey's biweight with 95 % efficiency for normal errors (Holland and Welsch 1977), and E[w x²] / E[w] for those.
constexpr double kCut = 4.685;
constexpr double kWeightedVariance = 0.8280730;

constexpr int kLeastPasses = 3;
constexpr int kMostPasses = 10;
constexpr double kSettled = 0.1; // of sigma, root mean square of a pass's change: far below what a point says

/// One reading of all points.
struct Pass {
    NormalEquations equations;
    MatrixXd weights; ///< Σ s w of each cell
    std::size_t outliers = 0;
};

/// What a lane gathers.
struct Lane {
    std::optional<CellMoments> moments; ///< with the first points: made by the thread that fills it
    std::size_t outliers = 0;
    PointCounts counts;
    std::vector<CellPoint> points;
    std::vector<double> r, w;
};

void weigh(Lane& lane, double cut)
{
    for (std::size_t i = 0; i < lane.points.size(); ++i) {
        const double t = lane.r[i] / cut;
        const double left = std::max(1 - t * t, 0.0);
        lane.w[i] = left * left;
        lane.outliers += left == 0;
    }
}

/// @param spline  with the trend
Pass read_points(const DensePoints& points, const Bspline& spline, double sigma)
{
    const std::vector<double> polynomials = cell_polynomials(spline);
    std::vector<Lane> lanes(kBlockLanes);
    for_blocks(points.source, [&](std::size_t k, std::size_t, const PointBlock& block) {
        Lane& lane = lanes[k];
        locate(points, block, lane.points, lane.counts);
        lane.r.resize(lane.points.size());
        lane.w.resize(lane.points.size());
        residuals(lane.points, polynomials, lane.r.data());
        weigh(lane, kCut * sigma);
        if (!lane.moments) lane.moments.emplace(points.grid);
        lane.moments->add(lane.points, lane.r.data(), lane.w.data());
    });
    for (std::size_t k = 1; k < kBlockLanes; ++k) {
        if (lanes[k].moments) lanes[0].moments->add(*lanes[k].moments);
        lanes[0].outliers += lanes[k].outliers;
    }
    const CellMoments sum = std::move(*lanes[0].moments);
    const std::size_t outliers = lanes[0].outliers;
    lanes.clear(); // before the matrix is made
    const MatrixXd s = density_factors(sum.weights());
    const MatrixXd weights = s.cwiseProduct(sum.weights());
    return {{sum.matrix(points.grid, s), sum.right(s), sum.square(s), weights.sum(),
             rounding_variance(points) * weights.sum()},
            weights,
            outliers};
}

/// The spline on its way.
struct State {
    Bspline spline; ///< without the trend
    VectorXd trend; ///< control heights
    double sigma = 0;
    double lambda = 0;
    double change = 0; ///< of the last pass
    int passes = 0;

    Bspline total() const
    {
        Bspline sum = spline;
        sum.heights += trend.reshaped(sum.heights.rows(), sum.heights.cols());
        return sum;
    }
};

/// Passes until they change nothing more. @return  the last, whose λ is that of the largest likelihood
Pass improve(const DensePoints& points, const Energy& energy, State& state)
{
    for (;;) {
        Pass pass = read_points(points, state.total(), state.sigma);
        ++state.passes;
        const VectorXd heights = state.spline.heights.reshaped();
        const Smoothed fit = state.passes < kLeastPasses
                                 ? smoothed(pass.equations, heights, energy, state.lambda)
                                 : smoothed_by_likelihood(pass.equations, heights, energy, state.lambda);
        state.spline.heights = fit.heights.reshaped(state.spline.heights.rows(), state.spline.heights.cols());
        state.lambda = fit.lambda;
        state.sigma = std::sqrt(std::max(fit.variance / kWeightedVariance, rounding_variance(points)));
        state.change = fit.change;
        const bool settled = state.passes >= kLeastPasses && state.change <= kSettled * state.sigma;
        if (settled || state.passes == kMostPasses) return pass;
    }
}

/// Middles of cells with points, about `spacing` apart: of each square the one nearest to its middle. M
Eigen::Matrix2Xd spread_cells(const Bspline& grid, const MatrixXd& weights, double spacing)
{
    std::map<std::pair<Index, Index>, std::pair<double, Vector2d>> nearest;
    for (Index column = 0; column < weights.cols(); ++column)
        for (Index row = 0; row < weights.rows(); ++row) {
            if (weights(row, column) == 0) continue;
            const Vector2d uv(static_cast<double>(row) + 0.5, static_cast<double>(column) + 0.5);
            const Vector2d square = (uv.cwiseProduct(grid.cell) / spacing).array().floor();
            const double distance =
                (uv.cwiseProduct(grid.cell) - (square + Vector2d::Constant(0.5)) * spacing).squaredNorm();
            const auto [at, added] =
                nearest.try_emplace({static_cast<Index>(square.x()), static_cast<Index>(square.y())}, distance, uv);
            constexpr double kTie = 1 - 1e-9; // rounding does not choose between two
            if (!added && distance < kTie * at->second.first) at->second = {distance, uv};
        }
    Eigen::Matrix2Xd xy(2, static_cast<Index>(nearest.size()));
    Index k = 0;
    for (const auto& [square, found] : nearest) xy.col(k++) = place_in(grid, found.second);
    return xy;
}

/// As spread_cells(), half of B apart if that gives neither too few nor too many.
Eigen::Matrix2Xd condensed_places(const Bspline& grid, const MatrixXd& weights, const Job& job)
{
    constexpr Index kFewest = 24; // a quadratic, and three times as many to tell its residual from
    constexpr Index kMost = 100;  // what the exact posterior takes for a few tens of milliseconds
    const Eigen::Matrix2Xd anomaly = rotation_working_machine(job.theta) * job.anomaly.topRows<2>();
    double spacing = (anomaly.rowwise().maxCoeff() - anomaly.rowwise().minCoeff()).maxCoeff() / 2;
    Eigen::Matrix2Xd xy = spread_cells(grid, weights, spacing);
    while (xy.cols() > kMost) xy = spread_cells(grid, weights, spacing *= std::numbers::sqrt2);
    while (xy.cols() < kFewest && spacing > grid.cell.minCoeff())
        xy = spread_cells(grid, weights, spacing /= std::numbers::sqrt2);
    return xy;
}

/// Fills in the condensed touches and the precision.
void believe(Surface& surface, const DensePoints& points, const Pass& pass, const Energy& energy, const State& state,
             const Job& job)
{
    const Bspline& spline = std::get<Bspline>(surface.shape);
    const Eigen::Matrix2Xd xy = condensed_places(points.grid, pass.weights, job);
    surface.touches.resize(3, xy.cols());
    surface.touches << xy, heights(surface, xy).transpose();
    surface.roles = Eigen::VectorXi::Ones(xy.cols());

    // Rounding must not swallow what bridges the gaps; with so exact points the precision says less than they do.
    const double fine = std::sqrt(kWeightedVariance) * state.sigma / std::sqrt(state.lambda);
    SplinePrecision known{pass.weights / (state.sigma * state.sigma), fine};
    FitInput condensed;
    condensed.xyz = surface.touches;
    condensed.roles = surface.roles;
    condensed.job = job;
    const double touch = std::sqrt(sigmas(spline, known, xy).squaredNorm() / static_cast<double>(xy.cols()));
    known.amplitude = std::max(fine, field_amplitude(condensed, touch));
    const double variance =
        std::max(state.sigma * state.sigma, least_lambda(pass.equations, energy) * known.amplitude * known.amplitude);
    known.weights = pass.weights / variance;
    for (std::size_t k = 0; k < points.cells.size(); ++k)
        if (points.cells[k] == DensePoints::edge_of_anomaly || points.cells[k] == DensePoints::edge_of_both)
            known.weights.data()[k] = 0;
    surface.precision = std::move(known);
}

} // namespace

bool is_dense(const PointSource& source, const Job& job, const std::string& method)
{
    return source.points > kMostExactTouches &&
           (method == "bspline" || (method == "auto" && job.surface == SurfaceType::freeform));
}

DenseFit fit_dense(const PointSource& source, const Job& job, bool use_boundary, const std::string& name)
{
    const DensePoints points = dense_points(source, job, use_boundary, name);
    State state;
    DenseFit result;
    {
        DenseStart start = dense_start(points, name);
        result.counts = start.counts;
        state.trend = quadratics(points.grid).heights * start.trend;
        state.spline = std::move(start.spline);
        state.sigma = start.sigma;
        state.lambda = start.lambda;
    }
    const Energy energy = energy_over(points.grid);
    const Pass pass = improve(points, energy, state);
    result.outliers = pass.outliers;
    result.fit.converged = state.change <= kSettled * state.sigma;
    result.fit.iterations = state.passes;
    Surface& surface = result.fit.surface;
    surface.units = job.units;
    surface.method = "bspline";
    surface.shape = state.total();
    surface.touch_sigma = state.sigma;
    surface.rms = std::sqrt(pass.equations.square / pass.equations.weight);
    surface.goodness = std::numeric_limits<double>::quiet_NaN();
    surface.ignored = static_cast<int>(std::min<std::size_t>(result.counts.ignored(), std::numeric_limits<int>::max()));
    believe(surface, points, pass, energy, state, job);
    return result;
}

} // namespace fettle
