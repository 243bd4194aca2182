#pragma once

#include <Eigen/Core>

#include <optional>

namespace fettle {

/// Three corners, mm.
using Triangle = Eigen::Matrix3d; // columns

/// Point of a triangle with its barycentric coordinates, exactly 0 off a vertex or edge that holds it.
struct TrianglePoint {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
    double squared_distance = 0; ///< to the point asked for
};

/// The nearest point of a triangle, which may be a needle or without area.
TrianglePoint closest_on_triangle(const Triangle& triangle, const Eigen::Vector3d& point);

/// A ray in the coordinates of the watertight test of Woop, Benthin & Wald (2013): two triangles that share an edge
/// leave no gap between them, because both take the same number, but for its sign, for the side of the edge.
class WatertightRay {
  public:
    /// @param direction  unit
    WatertightRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

    /// Distance along the ray to the triangle, edges and vertices included; nothing behind the origin, and nothing for
    /// a triangle seen on edge.
    std::optional<double> hit(const Triangle& triangle) const;

  private:
    Eigen::Vector3d origin_;
    int kx_, ky_, kz_; ///< kz: the axis along which the direction is longest
    double sx_, sy_, sz_;
};

} // namespace fettle
