#include "compare/form_start.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {

namespace {

// Points whose extent in a direction is below this share of the largest have none: the rounding of float coordinates.
constexpr double kFlat = 1e-6;

// Directions tried for the axis of a cylinder, over half a sphere, 5° apart: least squares finds its way from there.
constexpr int kDirections = 1000;
constexpr Eigen::Index kPointsTried = 500;

Eigen::Matrix3Xd thinned(const Eigen::Matrix3Xd& points)
{
    const Eigen::Index stride = std::max<Eigen::Index>(points.cols() / kPointsTried, 1);
    return points(Eigen::all, Eigen::seq(0, Eigen::last, stride));
}

/// Sphere or circle of algebraic least squares (Kåsa): |p|² = 2 p·c + k, linear in c and k.
struct Round {
    Eigen::VectorXd centre;
    double radius = 0;
    double rms = std::numeric_limits<double>::infinity(); ///< of the orthogonal distances
};

Round algebraic_fit(const Eigen::MatrixXd& points)
{
    const Eigen::Index dim = points.rows();
    Eigen::MatrixXd A(points.cols(), dim + 1);
    A.leftCols(dim) = 2 * points.transpose();
    A.col(dim).setOnes();
    const Eigen::VectorXd solution = least_squares_by_qr(A, points.colwise().squaredNorm().transpose()).x;
    Round round;
    round.centre = solution.head(dim);
    round.radius = std::sqrt(solution[dim] + round.centre.squaredNorm());
    const Eigen::VectorXd distance = (points.colwise() - round.centre).colwise().norm().transpose();
    round.rms = std::sqrt((distance.array() - round.radius).square().mean());
    return round;
}

FormElement cylinder_start(const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3Xd few = thinned(points);
    FormElement best{FormKind::cylindricity, {}, {}};
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kDirections; ++k) { // a spiral of equal areas over the upper half sphere
        const double z = (k + 0.5) / kDirections, turn = k * 2 * std::numbers::pi / std::numbers::phi;
        const double r = std::sqrt(1 - z * z);
        const Eigen::Vector3d axis(r * std::cos(turn), r * std::sin(turn), z);
        const Eigen::Vector3d u = axis.unitOrthogonal();
        Eigen::Matrix<double, 3, 2> across;
        across << u, axis.cross(u);
        const Round circle = algebraic_fit(across.transpose() * few);
        if (!(circle.rms < least)) continue;
        least = circle.rms;
        best.point = across * circle.centre;
        best.direction = axis;
        best.radius = circle.radius;
    }
    return best;
}

// The line of least squares in the section: the principal axis of the points as they lie in it.
FormElement line_start(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& thinnest, const Eigen::Vector3d& section)
{
    const Eigen::Vector3d across = section.isZero(0) ? thinnest : section;
    Eigen::Matrix<double, 3, 2> in_plane;
    in_plane << across.unitOrthogonal(), across.cross(across.unitOrthogonal());
    const Eigen::Matrix2Xd flat = in_plane.transpose() * points;
    const SymmetricEigen<2> spread = symmetric_eigen<2>(flat * flat.transpose());
    if (!(spread.values[1] > 0)) throw InputError("the points of the section lie in one place");
    return {FormKind::straightness, Eigen::Vector3d::Zero(), in_plane * spread.vectors.col(0), 0, across};
}

} // namespace

FormElement form_start(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    const Eigen::Index needed = is_flat(kind) ? 3 : kind == FormKind::sphericity ? 4 : 6;
    if (points.cols() < needed)
        throw InputError("needs at least " + std::to_string(needed) + " points, got " + std::to_string(points.cols()));
    const SymmetricEigen<3> spread = symmetric_eigen<3>(points * points.transpose());
    const Eigen::Vector3d extent = spread.values.cwiseMax(0).cwiseSqrt();
    if (kind == FormKind::straightness) return line_start(points, spread.vectors.col(0), section);
    if (extent[1] <= kFlat * extent[2]) throw InputError("the points lie on a line");
    if (kind == FormKind::flatness) return {kind, Eigen::Vector3d::Zero(), Eigen::Vector3d(spread.vectors.col(0))};
    if (extent[0] <= kFlat * extent[2]) throw InputError("the points lie in a plane: no curvature to fit");
    if (kind == FormKind::cylindricity) return cylinder_start(points);
    const Round sphere = algebraic_fit(thinned(points));
    return {kind, Eigen::Vector3d(sphere.centre), Eigen::Vector3d::UnitZ(), sphere.radius};
}

} // namespace fettle
