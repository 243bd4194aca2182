#include "fit/plane.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::fit {

namespace {

// Touches of a curved part lie on both edges of Huber's width, and the iteration converges slowly: 1500 steps have been
// met, and they take milliseconds.
constexpr int kMaxIterations = 10000;
constexpr double kRelativeChangeTolerance = 1e-6; // change of a touch's distance over the probe's accuracy: irrelevant
constexpr double kRelativeRounding = 1e-14;       // of distances over the coordinates that they are computed from
// n_z of 89.94°: a vertical probe cannot touch a steeper plane.
constexpr double kMinNormalZ = 1e-3;
// Single-precision files round coordinates by 6e-8 of their size, so smaller relative spreads are roundoff.
constexpr double kRoundingTolerance = 1e-6;

struct TotalLeastSquares {
    Eigen::Vector3d centroid;
    Eigen::Vector3d normal; ///< unit, up
    double width = 0;       ///< rms spread in the plane, perpendicular to the direction of the largest spread, mm
    double length = 0;      ///< largest rms spread, mm
};

TotalLeastSquares total_least_squares(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& weight)
{
    const double sum = weight.sum();
    const Eigen::Vector3d centroid = points * weight / sum;
    const Eigen::Matrix3Xd scaled = (points.colwise() - centroid) * (weight / sum).cwiseSqrt().asDiagonal();
    const core::SymmetricEigen<3> spread = core::symmetric_eigen<3>(scaled * scaled.transpose());
    const Eigen::Vector3d normal = spread.vectors.col(0);
    return {centroid, normal.z() < 0 ? Eigen::Vector3d(-normal) : normal, std::sqrt(std::max(spread.values[1], 0.0)),
            std::sqrt(spread.values[2])};
}

} // namespace

Fit fit_plane(const FitInput& input)
{
    surface::Surface surface = begin_surface(input, "plane", {0, 1, 2, 4, 5}, 3);
    const Eigen::Matrix3Xd& touches = surface.touches;
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(touches.cols());
    TotalLeastSquares tls = total_least_squares(touches, weight);
    if (tls.width <= std::max(input.job.probe.accuracy, kRoundingTolerance * tls.length))
        throw core::InputError(input.source, "touches lie on a line: across it they spread by only " +
                                                 core::to_text(tls.width / input.job.units.mm()) + " " +
                                                 units::to_string(input.job.units.length));
    const auto distances = [&] { return Eigen::VectorXd((touches.colwise() - tls.centroid).transpose() * tls.normal); };
    const double tolerance = std::max(kRelativeChangeTolerance * input.job.probe.accuracy,
                                      kRelativeRounding * touches.cwiseAbs().maxCoeff());
    Eigen::VectorXd distance = distances();
    bool converged = false;
    int iterations = 0;
    for (; iterations < kMaxIterations && !converged; ++iterations) {
        weight = distance.unaryExpr([&](double d) { return huber_weight(d, input.job.probe.accuracy); });
        tls = total_least_squares(touches, weight);
        const Eigen::VectorXd before = std::exchange(distance, distances());
        converged = (distance - before).cwiseAbs().maxCoeff() <= tolerance;
    }
    if (tls.normal.z() < kMinNormalZ)
        throw core::InputError(input.source, "touches lie on a vertical plane, which has no height over x and y");

    const surface::Plane plane{tls.centroid.head<2>(), tls.centroid.z(), -tls.normal.head<2>() / tls.normal.z()};
    surface.shape = plane;
    const Eigen::MatrixXd G = surface::height_gradients(plane, touches.topRows(2)); // columns: touches
    const Eigen::Matrix3d normal_matrix = G * weight.asDiagonal() * G.transpose();
    surface.covariance =
        surface.touch_sigma * surface.touch_sigma * normal_matrix.ldlt().solve(Eigen::Matrix3d::Identity());
    const double freedom = touches.cols() - 3;
    return finish_fit(std::move(surface), freedom, converged, iterations);
}

} // namespace fettle::fit
