#include "cad/face_triangle.h"

#include "cad/foot.h"
#include "cad/point.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace fettle::cad {
namespace {

constexpr int kMaxHalvings = 5; // the second differences of a bulge are then a thousandth of those over one interval

/// Finds the corners in which the surface stays where it is, whatever one of the parameters.
void find_singular_corners(const Adaptor3d_Surface& surface, FaceTriangle& t)
{
    constexpr double kMaxMotion = 1e-7; // mm, of a point that stays: OpenCASCADE's own tolerance of points
    for (int k = 0; k < 2; ++k) {
        const double min = t.uv.row(k).minCoeff(), max = t.uv.row(k).maxCoeff();
        if (min == max) continue;
        for (int corner = 0; corner < 3; ++corner) {
            const auto stays = [&](double parameter) {
                Eigen::Vector2d uv = t.uv.col(corner);
                uv[k] = parameter;
                return (vector_of(surface.Value(uv[0], uv[1])) - t.corners.col(corner)).norm() < kMaxMotion;
            };
            t.is_singular(k, corner) = stays(min) && stays(max) && stays((min + max) / 2);
        }
    }
}

/// Points over the grid of a triangle, (i, j) with i + j <= n.
class TriangleGrid {
  public:
    explicit TriangleGrid(int n) : n_(n), points_(static_cast<std::size_t>((n + 1) * (n + 2) / 2)) {}
    Eigen::Vector3d& at(int i, int j) { return points_[static_cast<std::size_t>(i * (2 * n_ + 3 - i) / 2 + j)]; }

    /// Largest second difference along the three directions of the grid.
    double second_difference()
    {
        double largest = 0;
        const auto add = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
            largest = std::max(largest, (a - 2 * b + c).norm());
        };
        for (int i = 0; i <= n_; ++i)
            for (int j = 0; i + j <= n_; ++j) {
                if (i + j + 2 <= n_) add(at(i, j), at(i + 1, j), at(i + 2, j));
                if (i + j + 2 <= n_) add(at(i, j), at(i, j + 1), at(i, j + 2));
                if (i + 2 <= n_ && j >= 2) add(at(i, j), at(i + 1, j - 1), at(i + 2, j - 2));
            }
        return largest;
    }

  private:
    int n_;
    std::vector<Eigen::Vector3d> points_;
};

/// Calls visit(i, j, point of the triangle, parameters) over the grid of a triangle.
template <typename Visit>
void over_grid(const FaceTriangle& t, int n, const Visit& visit)
{
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const Eigen::Vector3d barycentric = Eigen::Vector3d(n - i - j, i, j) / n;
            visit(i, j, Eigen::Vector3d(t.corners * barycentric), t.parameters(barycentric));
        }
}

/// The bound by a grid of n intervals.
struct GridBound {
    double distance = 0; ///< largest distance in the grid's points
    double between = 0;  ///< bound of what is added between them
};

GridBound bound_by_grid(const Adaptor3d_Surface& surface, const FaceTriangle& t, int n, Correspondence correspondence)
{
    TriangleGrid grid(n);
    GridBound bound;
    over_grid(t, n, [&](int i, int j, const Eigen::Vector3d& flat, const Eigen::Vector2d& uv) {
        grid.at(i, j) = correspondence == Correspondence::closest_point ? foot_on_surface(surface, uv, flat).point
                                                                        : vector_of(surface.Value(uv.x(), uv.y()));
        bound.distance = std::max(bound.distance, (grid.at(i, j) - flat).norm());
    });
    bound.between = grid.second_difference() / 6;
    return bound;
}

} // namespace

Eigen::Vector2d FaceTriangle::parameters(const Eigen::Vector3d& barycentric) const
{
    Eigen::Vector2d result = uv * barycentric;
    for (int k = 0; k < 2; ++k) {
        const Eigen::Array<bool, 1, 3> counts = !is_singular.row(k);
        if (counts.all() || !counts.any()) continue;
        const Eigen::RowVector3d equal = counts.cast<double>();
        Eigen::RowVector3d weights = equal.cwiseProduct(barycentric.transpose());
        if (!(weights.sum() > 0)) weights = equal;
        result[k] = weights.dot(uv.row(k)) / weights.sum();
    }
    return result;
}

FaceTriangle face_triangle(const Adaptor3d_Surface& surface, const mesh::Triangle& corners,
                           const Eigen::Matrix<double, 2, 3>& uv)
{
    FaceTriangle triangle{corners, uv};
    if (surface.GetType() != GeomAbs_Plane) find_singular_corners(surface, triangle);
    return triangle;
}

double triangle_bound(const Adaptor3d_Surface& surface, const FaceTriangle& triangle, double tolerance,
                      Correspondence correspondence)
{
    double bound = std::numeric_limits<double>::infinity();
    for (int halvings = 1; halvings <= kMaxHalvings && bound > tolerance; ++halvings) {
        const GridBound by_grid = bound_by_grid(surface, triangle, 1 << halvings, correspondence);
        bound = std::min(bound, by_grid.distance + by_grid.between);
        if (by_grid.distance > tolerance) break; // it only grows
    }
    return bound;
}

} // namespace fettle::cad
