#pragma once

#include "surface/delaunay.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::surface {

/// C1 piecewise cubic interpolation of values and gradients over a triangulation: each triangle has three cubics that
/// meet at its centroid (Clough and Tocher 1965). The derivative across an edge, in the direction that joins the
/// centroids of its two triangles, is linear along the edge, as in SciPy's CloughTocher2DInterpolator.
class CloughTocher {
  public:
    explicit CloughTocher(Triangulation triangulation);

    /// The height at a point as a linear function of the data at the three corners of its triangle.
    struct Weights {
        Eigen::Vector3i corners; ///< indices of points
        Eigen::Matrix3d weights; ///< column k: weights of the value, the x and the y derivative at corner k
    };
    /// @return  nothing outside the convex hull
    std::optional<Weights> weights(const Eigen::Vector2d& xy) const;

    const Triangulation& triangulation() const { return triangulation_; }

  private:
    struct Location {
        Eigen::Index triangle;
        Eigen::Vector3d barycentric;
    };
    std::optional<Location> locate(const Eigen::Vector2d& xy) const;
    Eigen::Vector2i bin_of(const Eigen::Vector2d& xy) const;

    Triangulation triangulation_;
    // Square bins over the bounding box, each with the triangles whose bounding boxes overlap it: triangles are
    // searched, not points, for which geometry::PointIndex is.
    Eigen::Vector2d min_corner_;
    double bin_side_ = 0;
    Eigen::Vector2i bins_; ///< number of bins in x and y
    std::vector<std::vector<int>> triangles_in_bin_;
};

/// Gradients at the points, estimated from their values by minimum curvature: they minimise the integral of the squared
/// second derivative along all edges, each edge a cubic of its end values and slopes (Nielson 1983; Renka and Cline
/// 1984). The solution is exact, not iterative, and hence linear in the values.
/// @param values  NxC, one column per field   @return 2NxC: rows 2i and 2i + 1 are the x and y derivative at point i
Eigen::MatrixXd min_curvature_gradients(const Triangulation& triangulation, const Eigen::MatrixXd& values);

} // namespace fettle::surface
