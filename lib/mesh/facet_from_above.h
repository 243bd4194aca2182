#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <optional>

namespace fettle {

/// A triangle of a mesh as a vertical ray meets it. Edges belong to their triangles, so no ray slips between two.
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

    /// z over xy, mm; nothing beside the triangle, nor on one seen on edge: its upper edge belongs to a neighbour.
    std::optional<double> height(const Eigen::Vector2d& xy) const
    {
        // Most triangles are passed by: two sides tell.
        const auto apart = [](double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); };
        const double u = edges_[0].side(xy), v = edges_[1].side(xy);
        if (apart(u, v)) return std::nullopt;
        const double w = edges_[2].side(xy);
        if (apart(u, w) || apart(v, w)) return std::nullopt;
        const double sum = u + v + w;
        if (sum == 0) return std::nullopt;
        return (u * z_[0] + v * z_[1] + w * z_[2]) / sum;
    }

  private:
    /// From the vertex of lower index to that of higher, so that both of its triangles compute the same side of it,
    /// but for the sign: a point is never on the outer side for both.
    struct Edge {
        Edge() = default;
        Edge(const Mesh& mesh, int a, int b)
            : from(mesh.vertices.col(a < b ? a : b).head<2>()), way(mesh.vertices.col(a < b ? b : a).head<2>() - from),
              sign(a < b ? 1 : -1)
        {
        }
        /// Twice the area of the edge and xy, positive on the left of a b.
        double side(const Eigen::Vector2d& xy) const
        {
            return sign * (way.x() * (xy.y() - from.y()) - way.y() * (xy.x() - from.x()));
        }

        Eigen::Vector2d from, way;
        double sign = 1;
    };

    Edge edges_[3]; ///< opposite to each corner
    double z_[3];   ///< of the corners
};

} // namespace fettle
