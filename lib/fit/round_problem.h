#pragma once

#include <Eigen/Core>

namespace fettle {

/// Where a round shape is looked for: a point near the touches, and a frame whose third column points up out of them.
struct RoundFrame {
    Eigen::Vector3d point;
    Eigen::Matrix3d axes; ///< columns: along the axis of a cylinder, across it, out of the metal
};

/// One solution, as small changes of the frame.
struct RoundSolution {
    Eigen::VectorXd parameters; ///< offset, tilts, (turn,) curvature
    double cost = 0;
    bool converged = false;
    int iterations = 0;
};

/// Ceres; θ = (offset along n, tilt of n across, tilt along, curvature).
RoundSolution solve_sphere(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, double curvature, double width);
/// θ = (offset along n, tilt of n across, tilt of n and axis along, turn of the axis about n, curvature).
RoundSolution solve_cylinder(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, double curvature, double width);

} // namespace fettle
