#include "fit/dense.h"

#include "fit/bspline.h"
#include "fit/robust_spline.h"
#include "geometry/bounding_box.h"
#include "surface/precision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Subsamples the cells with points: in each square of side `spacing` the cell nearest to its centre. @return  centres
/// of cells, 2xN, M, mm
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

/// Subsamples the cells at half the size of B, or at a spacing that yields neither too few nor too many. @return  2xN,
/// M, mm
Eigen::Matrix2Xd condensed_places(const surface::Bspline& grid, const MatrixXd& weights, const job::Job& job)
{
    constexpr Index kMinPlaces = 24;  // six parameters of a quadratic, and eighteen degrees of freedom of its residuals
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
void set_posterior(surface::Surface& surface, const RobustSpline& fit, const DensePoints& points, const job::Job& job)
{
    const surface::Bspline& spline = std::get<surface::Bspline>(surface.shape);
    const Eigen::Matrix2Xd xy = condensed_places(points.grid, fit.last.weights, job);
    surface.touches.resize(3, xy.cols());
    surface.touches << xy, surface::heights(surface, xy).transpose();
    surface.roles = Eigen::VectorXi::Ones(xy.cols());

    // The smallest λ at which the energy that bridges gaps is not lost by rounding is a lower bound of the variance.
    // For more exact points the precision is underestimated.
    const double fine_amplitude = std::sqrt(kBiweightVariance) * fit.sigma / std::sqrt(fit.lambda);
    surface::SplinePrecision precision{fit.last.weights / (fit.sigma * fit.sigma), fine_amplitude};
    FitInput condensed;
    condensed.xyz = surface.touches;
    condensed.roles = surface.roles;
    condensed.job = job;
    const double touch = std::sqrt(surface::sigmas(spline, precision, xy).squaredNorm() / xy.cols());
    precision.amplitude = std::max(fine_amplitude, estimate_field_amplitude(condensed, touch));
    const double variance = std::max(fit.sigma * fit.sigma, min_lambda(fit.last.equations, fit.energy) *
                                                                precision.amplitude * precision.amplitude);
    precision.weights = fit.last.weights / variance;
    for (std::size_t k = 0; k < points.cells.size(); ++k)
        if (points.cells[k] == DensePoints::edge_of_anomaly || points.cells[k] == DensePoints::edge_of_both)
            precision.weights.data()[k] = 0;
    surface.precision = std::move(precision);
}

} // namespace

int ignored_count(const PointCounts& counts)
{
    return static_cast<int>(std::min<std::size_t>(counts.ignored(), std::numeric_limits<int>::max()));
}

DenseFit fit_dense(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                   const std::string& name)
{
    const DensePoints points = dense_points(source, job, filter, name);
    const RobustSpline spline = fit_robust_spline(points, name);
    DenseFit result;
    result.counts = spline.counts;
    result.outliers = spline.last.outliers;
    result.point_sigma = spline.sigma;
    result.fit.converged = spline.converged();
    result.fit.iterations = spline.passes;
    surface::Surface& surface = result.fit.surface;
    surface.units = job.units;
    surface.method = "bspline";
    surface.shape = spline.with_trend();
    surface.touch_sigma = spline.sigma;
    surface.rms = std::sqrt(spline.last.equations.square_sum / spline.last.equations.weight_sum);
    surface.goodness = std::numeric_limits<double>::quiet_NaN();
    surface.ignored = ignored_count(result.counts);
    set_posterior(surface, spline, points, job);
    return result;
}

} // namespace fettle::fit
