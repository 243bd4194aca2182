#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <memory>

namespace fettle {

/// Where facets of a mesh stand upright: seen from above these are lines. Thread-safe.
class Walls {
  public:
    /// @param cell  about the size of the triangles that will be asked for, mm
    Walls(const Mesh& mesh, double cell);
    ~Walls();

    /// Does a wall run through a triangle (seen from above, 2x3), or along its border?
    bool meet(const Eigen::Matrix<double, 2, 3>& triangle) const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle
