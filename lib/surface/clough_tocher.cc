#include "surface/clough_tocher.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace fettle::surface {

namespace {

// Barycentric tolerance by which a point may lie outside a triangle: rounding of points on an edge of the hull.
constexpr double kBarycentricTolerance = 1e-9;

// A Bernstein coefficient as a linear function of the data at the corners: row 3k + d is the weight of the value (d =
// 0) or of the x or y derivative (d = 1, 2) at corner k.
using Coefficient = Eigen::Matrix<double, 9, 1>;

Eigen::Vector3d barycentric_of(const Triangulation& mesh, Eigen::Index t, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d origin = mesh.points.col(mesh.triangles(2, t));
    Eigen::Matrix2d sides;
    sides << mesh.points.col(mesh.triangles(0, t)) - origin, mesh.points.col(mesh.triangles(1, t)) - origin;
    const Eigen::Vector2d ab = sides.inverse() * (xy - origin);
    return {ab.x(), ab.y(), 1 - ab.sum()};
}

Eigen::Vector2d centroid(const Triangulation& mesh, Eigen::Index t)
{
    return (mesh.points.col(mesh.triangles(0, t)) + mesh.points.col(mesh.triangles(1, t)) +
            mesh.points.col(mesh.triangles(2, t))) /
           3;
}

/// Bernstein coefficients of the three cubics of one triangle. Corner k is opposite edge k, which runs from corner
/// k + 1 to corner k + 2 (modulo 3); the cubic at edge k is b(i, j, l) over (corner k + 1, corner k + 2, centroid).
struct SplitTriangle {
    std::array<Coefficient, 3> corner;               ///< at the corner
    std::array<std::array<Coefficient, 3>, 3> along; ///< [k][m], m != k: on the side from k to m, next to k
    std::array<Coefficient, 3> inward;               ///< on the line to the centroid, next to corner k
    std::array<Coefficient, 3> across;               ///< in the middle of the cubic at edge k
    std::array<Coefficient, 3> inner;                ///< on the line to the centroid, next to the centroid
    Coefficient centre;
};

/// Parameter g of the cross direction at edge k, which joins the centroids of the triangle and its neighbour: the
/// direction is proportional to (centroid - corner k+1) + g (corner k+2 - corner k+1).
double cross_direction(const Triangulation& mesh, Eigen::Index t, int k)
{
    const int neighbour = mesh.neighbours(k, t);
    if (neighbour < 0) return -0.5; // hull edge: the direction from the centroid to the middle of the edge
    const Eigen::Vector3d c = barycentric_of(mesh, t, centroid(mesh, neighbour));
    const double first = c[(k + 1) % 3];
    const double second = c[(k + 2) % 3];
    return (2 * second + first - 1) / (2 - 3 * second - 3 * first);
}

SplitTriangle split(const Triangulation& mesh, Eigen::Index t)
{
    SplitTriangle b;
    for (int k = 0; k < 3; ++k) {
        b.corner[k] = Coefficient::Unit(3 * k);
        for (const int m : {(k + 1) % 3, (k + 2) % 3}) {
            const Eigen::Vector2d side = mesh.points.col(mesh.triangles(m, t)) - mesh.points.col(mesh.triangles(k, t));
            b.along[k][m] = b.corner[k];
            b.along[k][m].segment<2>(3 * k + 1) = side / 3;
        }
    }
    for (int k = 0; k < 3; ++k) {
        const int p = (k + 1) % 3, q = (k + 2) % 3;
        b.inward[k] = (b.corner[k] + b.along[k][p] + b.along[k][q]) / 3;
    }
    for (int k = 0; k < 3; ++k) {
        const int p = (k + 1) % 3, q = (k + 2) % 3;
        // The derivative in the cross direction is a quadratic along the edge; it is linear if its second difference
        // vanishes, which leaves one equation for the middle coefficient.
        const double g = cross_direction(mesh, t, k);
        const Coefficient third = -b.corner[p] + 3 * b.along[p][q] - 3 * b.along[q][p] + b.corner[q];
        const Coefficient median = -b.corner[p] + 2 * b.along[p][q] - b.along[q][p] + b.inward[p] + b.inward[q];
        b.across[k] = (g * third + median) / 2;
    }
    for (int k = 0; k < 3; ++k) b.inner[k] = (b.inward[k] + b.across[(k + 1) % 3] + b.across[(k + 2) % 3]) / 3;
    b.centre = (b.inner[0] + b.inner[1] + b.inner[2]) / 3;
    return b;
}

/// Evaluates the cubic that contains the point, the one at the edge opposite the smallest barycentric coordinate.
Coefficient evaluate(const SplitTriangle& b, const Eigen::Vector3d& barycentric)
{
    int k = 0;
    const double min = barycentric.minCoeff(&k);
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    const double u = barycentric[p] - min, v = barycentric[q] - min, w = 3 * min;
    return u * u * u * b.corner[p] + v * v * v * b.corner[q] + w * w * w * b.centre +
           3 * u * u * (v * b.along[p][q] + w * b.inward[p]) + 3 * v * v * (u * b.along[q][p] + w * b.inward[q]) +
           3 * w * w * (u * b.inner[p] + v * b.inner[q]) + 6 * u * v * w * b.across[k];
}

} // namespace

CloughTocher::CloughTocher(Triangulation triangulation) : triangulation_(std::move(triangulation))
{
    const Eigen::Matrix2Xd& points = triangulation_.points;
    min_corner_ = points.rowwise().minCoeff();
    const Eigen::Vector2d size = points.rowwise().maxCoeff() - min_corner_;
    bin_side_ = size.maxCoeff() / std::ceil(std::sqrt(triangulation_.triangles.cols()));
    bins_ = (size / bin_side_).array().floor().cast<int>() + 1;
    triangles_in_bin_.resize(bins_.prod());
    for (Eigen::Index t = 0; t < triangulation_.triangles.cols(); ++t) {
        Eigen::Matrix<double, 2, 3> corners;
        for (int k = 0; k < 3; ++k) corners.col(k) = points.col(triangulation_.triangles(k, t));
        const Eigen::Vector2i from = bin_of(corners.rowwise().minCoeff());
        const Eigen::Vector2i to = bin_of(corners.rowwise().maxCoeff());
        for (int row = from.y(); row <= to.y(); ++row)
            for (int column = from.x(); column <= to.x(); ++column)
                triangles_in_bin_[row * bins_.x() + column].push_back(t);
    }
}

/// The bin of a point; for a point outside the bounding box, the nearest bin.
Eigen::Vector2i CloughTocher::bin_of(const Eigen::Vector2d& xy) const
{
    const Eigen::Array2d bin = ((xy - min_corner_) / bin_side_).array().floor();
    return bin.max(0).min((bins_.array() - 1).cast<double>()).cast<int>();
}

std::optional<CloughTocher::Location> CloughTocher::locate(const Eigen::Vector2d& xy) const
{
    if (!xy.allFinite()) return {};
    const Eigen::Vector2i bin = bin_of(xy);
    for (const int t : triangles_in_bin_[bin.y() * bins_.x() + bin.x()]) {
        const Eigen::Vector3d b = barycentric_of(triangulation_, t, xy);
        if (b.minCoeff() >= -kBarycentricTolerance) return Location{t, b};
    }
    return {};
}

std::optional<CloughTocher::Weights> CloughTocher::weights(const Eigen::Vector2d& xy) const
{
    const std::optional<Location> location = locate(xy);
    if (!location) return {};
    const Coefficient data_weights = evaluate(split(triangulation_, location->triangle), location->barycentric);
    return Weights{triangulation_.triangles.col(location->triangle),
                   Eigen::Map<const Eigen::Matrix3d>(data_weights.data())};
}

Eigen::MatrixXd min_curvature_gradients(const Triangulation& triangulation, const Eigen::MatrixXd& values)
{
    std::set<std::pair<int, int>> edges;
    for (Eigen::Index t = 0; t < triangulation.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k)
            edges.insert(std::minmax({triangulation.triangles(k, t), triangulation.triangles((k + 1) % 3, t)}));

    // On an edge e of length L with slopes a = e·∇1, b = e·∇2 and rise f, the integral of the squared second derivative
    // is 4 (a² + ab + b² - 3 f (a + b) + 3 f²) / L³. Half its derivative gives the normal equations.
    const Eigen::Index unknowns = 2 * triangulation.points.cols();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, values.cols());
    for (const auto& [i, j] : edges) {
        const Eigen::Vector2d e = triangulation.points.col(j) - triangulation.points.col(i);
        const double weight = 1 / (e.squaredNorm() * e.norm());
        const Eigen::RowVectorXd rise = values.row(j) - values.row(i);
        for (const auto& [own, other] : {std::pair(i, j), std::pair(j, i)})
            for (int d = 0; d < 2; ++d) {
                for (int c = 0; c < 2; ++c) {
                    entries.emplace_back(2 * own + d, 2 * own + c, 2 * weight * e[d] * e[c]);
                    entries.emplace_back(2 * own + d, 2 * other + c, weight * e[d] * e[c]);
                }
                right.row(2 * own + d) += 3 * weight * e[d] * rise;
            }
    }
    Eigen::SparseMatrix<double> normal(unknowns, unknowns);
    normal.setFromTriplets(entries.begin(), entries.end());
    // LDLT: every point has edges in two directions, so the matrix is positive definite.
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
    return factor.solve(right);
}

} // namespace fettle::surface
