#include "fit/plane.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

constexpr int kMostIterations = 100;
constexpr double kSettled = 1e-12; // change of the unit normal: rounding
// A plane steeper than 89.94° is no height field that a vertical probe could touch.
constexpr double kLeastUpward = 1e-3;
// Touches in F4 are rounded by 6e-8 of their size; a spread across the line below that is not there.
constexpr double kRounding = 1e-6;

struct Tls {
    Eigen::Vector3d centroid;
    Eigen::Vector3d normal; ///< unit, up
    double across = 0;      ///< rms spread in the plane, across the direction of the largest spread, mm
    double along = 0;       ///< largest rms spread, mm
};

Tls total_least_squares(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& weight)
{
    const double sum = weight.sum();
    const Eigen::Vector3d centroid = points * weight / sum;
    const Eigen::Matrix3Xd scaled = (points.colwise() - centroid) * (weight / sum).cwiseSqrt().asDiagonal();
    const SymmetricEigen<3> spread = symmetric_eigen<3>(scaled * scaled.transpose());
    const Eigen::Vector3d normal = spread.vectors.col(0);
    return {centroid, normal.z() < 0 ? Eigen::Vector3d(-normal) : normal, std::sqrt(std::max(spread.values[1], 0.0)),
            std::sqrt(spread.values[2])};
}

} // namespace

Fit fit_plane(const FitInput& input)
{
    Surface surface = begin_surface(input, "plane", {0, 1, 2, 4, 5}, 3);
    const Eigen::Matrix3Xd& touches = surface.touches;
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(touches.cols());
    Tls tls = total_least_squares(touches, weight);
    if (tls.across <= std::max(input.job.probe.accuracy, kRounding * tls.along))
        throw InputError(input.source, "touches lie on a line: across it they spread by only " +
                                           to_text(tls.across / input.job.units.mm()) + " " +
                                           to_string(input.job.units.length));
    bool settled = false;
    int iterations = 0;
    for (; iterations < kMostIterations && !settled; ++iterations) {
        const Eigen::VectorXd distance = (touches.colwise() - tls.centroid).transpose() * tls.normal;
        weight = distance.unaryExpr([&](double d) { return huber_weight(d, input.job.probe.accuracy); });
        const Tls next = total_least_squares(touches, weight);
        settled = (next.normal - tls.normal).norm() < kSettled;
        tls = next;
    }
    if (tls.normal.z() < kLeastUpward)
        throw InputError(input.source, "touches lie on a vertical plane, which has no height over x and y");

    const Plane plane{tls.centroid.head<2>(), tls.centroid.z(), -tls.normal.head<2>() / tls.normal.z()};
    surface.shape = plane;
    const Eigen::MatrixXd G = height_gradients(plane, touches.topRows(2)); // columns: touches
    const Eigen::Matrix3d normal_matrix = G * weight.asDiagonal() * G.transpose();
    surface.covariance =
        surface.touch_sigma * surface.touch_sigma * normal_matrix.ldlt().solve(Eigen::Matrix3d::Identity());
    const auto freedom = static_cast<double>(touches.cols() - 3);
    return finish_fit(std::move(surface), freedom, settled, iterations);
}

} // namespace fettle
