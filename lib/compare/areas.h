#pragma once

#include "cloud/point_source.h"
#include "compare/signed_distance.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::compare {

/// Barycentric area of each vertex: a third of its facets, mm².
Eigen::VectorXd vertex_areas(const mesh::Mesh& mesh);
/// Barycentric areas projected along `direction` (unit), mm².
Eigen::VectorXd vertex_areas(const mesh::Mesh& mesh, const Eigen::Vector3d& direction);

/// Area in the x-y plane of each point of a cloud. For a regular grid at any rotation it is one cell, exactly. Other
/// clouds are binned in squares of about 16 points, which share the area of their square; the error of a sum is about
/// half a square along the border.
class PlanAreas {
  public:
    /// Reads the points a few times.
    explicit PlanAreas(const cloud::PointSource& points);

    /// @param xyz  points of the source, 3xN, mm   @return  mm²; 0 for NaN points
    Eigen::VectorXd operator()(const Eigen::Matrix3Xd& xyz) const;

  private:
    Eigen::Index bin(const Eigen::Vector2d& xy) const;

    double cell_ = 0; ///< of a regular grid, mm²; 0: binned
    Eigen::Array2d min_ = {0, 0}, bin_size_ = {0, 0};
    Eigen::Array<Eigen::Index, 2, 1> bins_ = {0, 0};
    std::vector<std::uint32_t> counts_;
};

/// Weights by which errors of a cloud are multiplied to give volumes, mm²: the area of the reference over each plan
/// area or, in mode direction, its projection along that direction. 0 where the reference is steeper than 84°: a plan
/// area does not determine the area of a wall.
Eigen::VectorXd volume_weights(const Eigen::VectorXd& plan_areas, const ErrorMap& map, const DistanceOptions& options);
/// Weights of the errors at a mesh's vertices.
Eigen::VectorXd volume_weights(const mesh::Mesh& mesh, const DistanceOptions& options);

} // namespace fettle::compare
