#pragma once

#include "cloud/point_source.h"
#include "compare/signed_distance.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle {

/// The area that each vertex stands for: a third of its facets, mm².
Eigen::VectorXd vertex_areas(const Mesh& mesh);
/// The same as seen along `direction` (unit).
Eigen::VectorXd vertex_areas(const Mesh& mesh, const Eigen::Vector3d& direction);

/// The area in x-y that the points of a cloud stand for. On a regular grid, whatever its turn, one cell, exactly. Other
/// clouds are binned in squares of about 16 points, and a point gets its share of its square: sums are right but for
/// half a square along the border.
class PlanAreas {
  public:
    /// Reads the points a few times.
    explicit PlanAreas(const PointSource& points);

    /// Of points of the source, mm²; NaN points have none. @param xyz  3xN, mm
    Eigen::VectorXd operator()(const Eigen::Matrix3Xd& xyz) const;

  private:
    Eigen::Index bin(const Eigen::Vector2d& xy) const;

    double cell_ = 0; ///< of a grid; 0: binned
    Eigen::Array2d least_ = {0, 0}, side_ = {0, 0};
    Eigen::Array<Eigen::Index, 2, 1> bins_ = {0, 0};
    std::vector<std::uint32_t> counts_;
};

/// What to multiply the errors of a cloud with to get volumes, mm²: the element of the reference over each plan area,
/// or what is seen of it along the direction of the error. Where the reference is a wall (steeper than 84°) a view from
/// above has no area to share out: 0.
Eigen::VectorXd volume_areas(const Eigen::VectorXd& plan_areas, const ErrorMap& map, const DistanceOptions& options);
/// The same for the errors of a mesh's vertices.
Eigen::VectorXd volume_areas(const Mesh& mesh, const DistanceOptions& options);

} // namespace fettle
