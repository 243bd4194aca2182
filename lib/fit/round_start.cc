#include "fit/round_start.h"

#include "core/decompositions.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <cmath>

namespace fettle::fit {

RoundStart round_start(const TouchSet& touches, const TouchIndices& kept, const surface::Polynomial& frame)
{
    const Eigen::Matrix3Xd xyz = touches.xyz(Eigen::all, kept);
    const Eigen::MatrixXd A = surface::height_gradients(frame, xyz.topRows(2)).transpose();
    const auto [c, rank] = core::min_norm_least_squares(A, xyz.row(2).transpose(), kSolutionRankThreshold);

    RoundStart start;
    start.is_determined = rank == A.cols();
    const Eigen::Vector2d slope = c.segment<2>(1) / frame.scale;
    const Eigen::Vector3d n = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    Eigen::Matrix3d& axes = start.problem.frame.axes;
    axes.col(2) = n;
    const auto tangent = [&](const Eigen::Vector2d& along) {
        return Eigen::Vector3d(along.x(), along.y(), slope.dot(along)).normalized();
    };
    axes.col(0) = tangent({std::cos(touches.direction), std::sin(touches.direction)});
    // The second axis is horizontal, so that tilting the frame along its first axis keeps that axis in its vertical
    // plane.
    if (touches.given_direction) axes.col(2) = (Eigen::Vector3d::UnitZ() - axes(2, 0) * axes.col(0)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    start.problem.frame.point << frame.origin, c[0];
    start.problem.given_direction = touches.given_direction;
    start.problem.touches = xyz;

    // Weingarten map of the quadratic: its Hessian in x-y, transformed to the tangents.
    Eigen::Matrix2d hessian;
    hessian << 2 * c[3], c[4], c[4], 2 * c[5];
    hessian *= -n.z() / (frame.scale * frame.scale);
    const Eigen::Matrix2d tangents_xy = axes.topLeftCorner<2, 2>();
    const Eigen::Matrix2d shape = tangents_xy.transpose() * hessian * tangents_xy;
    if (touches.given_direction) {
        start.min_curvature = shape(0, 0);
        start.max_curvature = shape(1, 1);
    } else {
        const core::SymmetricEigen<2> eigen = core::symmetric_eigen(shape);
        const int smaller = std::abs(eigen.values[0]) < std::abs(eigen.values[1]) ? 0 : 1;
        start.min_curvature = eigen.values[smaller];
        start.max_curvature = eigen.values[1 - smaller];
        axes.col(0) = (axes.leftCols<2>() * eigen.vectors.col(smaller)).normalized().eval();
        axes.col(1) = n.cross(axes.col(0));
    }
    // To first order, the orthogonal distance over n_z is the vertical error.
    start.problem.weight.resize(xyz.cols());
    surface::Polynomial quadratic = frame;
    quadratic.coefficients = c;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        const double steepness = surface::slope(quadratic, xyz.col(i).head<2>()).squaredNorm();
        start.problem.weight[i] = std::sqrt(1 + steepness) / touches.sigma;
    }
    return start;
}

RoundFrame rotated(const RoundFrame& frame, double angle)
{
    RoundFrame result = frame;
    result.axes.col(0) = std::cos(angle) * frame.axes.col(0) + std::sin(angle) * frame.axes.col(1);
    result.axes.col(1) = frame.axes.col(2).cross(result.axes.col(0));
    return result;
}

} // namespace fettle::fit
