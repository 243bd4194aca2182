#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <optional>

namespace fettle::mesh {

/// Intersects vertical rays with a triangle of a mesh. Edges belong to both of their triangles, so no ray passes
/// between neighbours.
class FacetFromAbove {
  public:
    FacetFromAbove(const Mesh& mesh, Eigen::Index triangle)
    {
        const Eigen::Vector3i corners = mesh.triangles.col(triangle);
        for (int k = 0; k < 3; ++k) {
            edges_[k] = Edge(mesh, corners[(k + 1) % 3], corners[(k + 2) % 3]);
            z_[k] = mesh.vertices(2, corners[k]);
        }
    }

    /// z of the triangle at xy, mm; nothing outside the triangle, or if it is vertical: then a neighbour has its upper
    /// edge.
    std::optional<double> height(const Eigen::Vector2d& xy) const
    {
        // Most rays miss, and already the first two sides differ in sign.
        const auto opposite = [](double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); };
        const double u = edges_[0].side(xy), v = edges_[1].side(xy);
        if (opposite(u, v)) return std::nullopt;
        const double w = edges_[2].side(xy);
        if (opposite(u, w) || opposite(v, w)) return std::nullopt;
        const double sum = u + v + w;
        if (sum == 0) return std::nullopt;
        return (u * z_[0] + v * z_[1] + w * z_[2]) / sum;
    }

  private:
    /// An edge from its vertex of lower index to that of higher, so that both of its triangles compute the same side of
    /// it except for the sign: a point is never outside both.
    struct Edge {
        Edge() = default;
        Edge(const Mesh& mesh, int a, int b)
            : from(mesh.vertices.col(a < b ? a : b).head<2>()),
              along(mesh.vertices.col(a < b ? b : a).head<2>() - from), sign(a < b ? 1 : -1)
        {
        }
        /// Twice the signed area of the triangle (a, b, xy), positive if xy is to the left of the edge.
        double side(const Eigen::Vector2d& xy) const
        {
            return sign * (along.x() * (xy.y() - from.y()) - along.y() * (xy.x() - from.x()));
        }

        Eigen::Vector2d from, along;
        double sign = 1;
    };

    Edge edges_[3]; ///< opposite to each corner
    double z_[3];   ///< of the corners
};

} // namespace fettle::mesh
