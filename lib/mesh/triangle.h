#pragma once

#include <Eigen/Core>

#include <optional>

namespace fettle::mesh {

/// The corners of a triangle, one per column, mm.
using Triangle = Eigen::Matrix3d;

/// Point of a triangle with its barycentric coordinates: of a point on an edge or vertex the others are exactly 0.
struct TrianglePoint {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
    double squared_distance = 0; ///< to the query point, mm²
};

/// Closest point of a triangle, which may be a needle or degenerate.
TrianglePoint closest_on_triangle(const Triangle& triangle, const Eigen::Vector3d& point);

/// Watertight ray-triangle intersection (Woop, Benthin & Wald 2013): no ray passes between two triangles that share an
/// edge, because for both the side of the edge is the same number except for its sign.
class WatertightRay {
  public:
    /// @param direction  unit
    WatertightRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

    /// Distance along the ray to the triangle, including its edges and vertices, mm; nothing behind the origin or if
    /// the triangle is parallel to the ray.
    std::optional<double> hit(const Triangle& triangle) const;

  private:
    Eigen::Vector3d origin_;
    int kx_, ky_, kz_; ///< permuted axes; the direction is longest along kz
    double sx_, sy_, sz_;
};

} // namespace fettle::mesh
