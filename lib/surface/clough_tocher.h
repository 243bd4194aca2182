#pragma once

#include "surface/delaunay.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// The C1 piecewise cubic over a triangulation that takes given values and gradients at its points: in each triangle
/// three cubics that meet in the centroid (Clough and Tocher 1965), the derivative across each edge linear along the
/// direction that joins the centroids of the two triangles (as SciPy's CloughTocher2DInterpolator).
class CloughTocher {
  public:
    explicit CloughTocher(Triangulation triangulation);

    /// The height at a point is linear in what the three corners of its triangle carry.
    struct Weights {
        Eigen::Vector3i corners;
        Eigen::Matrix3d weights; ///< column k: of the value, its x and its y derivative at corner k
    };
    /// Nothing outside the convex hull.
    std::optional<Weights> weights(const Eigen::Vector2d& xy) const;

    const Triangulation& triangulation() const { return triangulation_; }

  private:
    struct Place {
        Eigen::Index triangle;
        Eigen::Vector3d barycentric;
    };
    std::optional<Place> locate(const Eigen::Vector2d& xy) const;
    Eigen::Vector2i bin_of(const Eigen::Vector2d& xy) const;

    Triangulation triangulation_;
    // Square bins over the bounding box with the triangles whose own boxes meet them.
    Eigen::Vector2d least_;
    double bin_ = 0;
    Eigen::Vector2i bins_;
    std::vector<std::vector<int>> triangles_in_;
};

/// Gradients at the points from their values by least curvature: they minimise the integral of the squared second
/// derivative along all edges, each edge a cubic of its end values and slopes (Nielson 1983; Renka and Cline 1984).
/// Solved exactly, so it is linear.
/// @param values  NxC, one column a field   @return 2NxC: rows 2i and 2i + 1 are the x and y derivative at point i
Eigen::MatrixXd least_curvature_gradients(const Triangulation& triangulation, const Eigen::MatrixXd& values);

} // namespace fettle
