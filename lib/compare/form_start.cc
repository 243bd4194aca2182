#include "compare/form_start.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/text.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <numbers>

namespace fettle::compare {

namespace {

// The extent of points in a direction counts as zero below this share of the largest: rounding of float coordinates.
constexpr double kMinRelativeExtent = 1e-6;

// Directions tried for the axis of a cylinder, over half a sphere, 5° apart: least squares converges from there.
constexpr int kAxisDirections = 1000;
constexpr Eigen::Index kMaxTrialPoints = 500;

Eigen::Matrix3Xd subsample(const Eigen::Matrix3Xd& points)
{
    const Eigen::Index stride = std::max<Eigen::Index>(points.cols() / kMaxTrialPoints, 1);
    return points(Eigen::all, Eigen::seq(0, Eigen::last, stride));
}

/// Sphere or circle by algebraic least squares (Kåsa): |p|² = 2 p·c + k, linear in c and k.
struct RoundFit {
    Eigen::VectorXd centre;
    double radius = 0;
    double rms = std::numeric_limits<double>::infinity(); ///< of the orthogonal distances
};

RoundFit fit_algebraically(const Eigen::MatrixXd& points)
{
    const Eigen::Index dim = points.rows();
    Eigen::MatrixXd A(points.cols(), dim + 1);
    A.leftCols(dim) = 2 * points.transpose();
    A.col(dim).setOnes();
    const Eigen::VectorXd solution = core::least_squares_by_qr(A, points.colwise().squaredNorm().transpose()).x;
    RoundFit fit;
    fit.centre = solution.head(dim);
    fit.radius = std::sqrt(solution[dim] + fit.centre.squaredNorm());
    const Eigen::VectorXd distances = (points.colwise() - fit.centre).colwise().norm().transpose();
    fit.rms = std::sqrt((distances.array() - fit.radius).square().mean());
    return fit;
}

FormElement initial_cylinder(const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3Xd sample = subsample(points);
    FormElement best{FormKind::cylindricity, {}, {}};
    double min_rms = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kAxisDirections; ++k) { // Fibonacci spiral over the upper half sphere
        const double z = (k + 0.5) / kAxisDirections, turn = k * 2 * std::numbers::pi / std::numbers::phi;
        const double r = std::sqrt(1 - z * z);
        const Eigen::Vector3d axis(r * std::cos(turn), r * std::sin(turn), z);
        const Eigen::Vector3d u = axis.unitOrthogonal();
        Eigen::Matrix<double, 3, 2> across;
        across << u, axis.cross(u);
        const RoundFit circle = fit_algebraically(across.transpose() * sample);
        if (!(circle.rms < min_rms)) continue;
        min_rms = circle.rms;
        best.point = across * circle.centre;
        best.direction = axis;
        best.radius = circle.radius;
    }
    return best;
}

// Least squares line in the section: the principal axis of the points projected onto its plane.
FormElement initial_line(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& normal)
{
    Eigen::Matrix<double, 3, 2> in_plane;
    in_plane << normal.unitOrthogonal(), normal.cross(normal.unitOrthogonal());
    const Eigen::Matrix2Xd flat = in_plane.transpose() * points;
    const core::SymmetricEigen<2> scatter = core::symmetric_eigen<2>(flat * flat.transpose());
    if (!(scatter.values[1] > 0)) throw core::InputError("the points of the section coincide");
    return {FormKind::straightness, Eigen::Vector3d::Zero(), in_plane * scatter.vectors.col(0), 0, normal};
}

} // namespace

FormElement initial_element(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    const Eigen::Index needed = is_flat(kind) ? 3 : kind == FormKind::sphericity ? 4 : 6;
    if (points.cols() < needed)
        throw core::InputError("needs at least " + std::to_string(needed) + " points, got " +
                               std::to_string(points.cols()));
    const core::SymmetricEigen<3> scatter = core::symmetric_eigen<3>(points * points.transpose());
    const Eigen::Vector3d extent = scatter.values.cwiseMax(0).cwiseSqrt();
    const Eigen::Vector3d thinnest = scatter.vectors.col(0);
    if (kind == FormKind::straightness) return initial_line(points, section.isZero(0) ? thinnest : section);
    if (extent[1] <= kMinRelativeExtent * extent[2]) throw core::InputError("the points lie on a line");
    if (kind == FormKind::flatness) return {kind, Eigen::Vector3d::Zero(), thinnest};
    if (extent[0] <= kMinRelativeExtent * extent[2])
        throw core::InputError("the points lie in a plane: no curvature to fit");
    if (kind == FormKind::cylindricity) return initial_cylinder(points);
    const RoundFit sphere = fit_algebraically(subsample(points));
    return {kind, Eigen::Vector3d(sphere.centre), Eigen::Vector3d::UnitZ(), sphere.radius};
}

} // namespace fettle::compare
