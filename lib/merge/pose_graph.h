#pragma once

#include "align/rigid.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace fettle::merge {

/// A measured pose of scan a on scan b. The cost of a pose T_b_a is xᵀ information x, where the twist x in `frame`
/// leads from the measured pose to it: T_b_a = frame.motion(x) · measured.
struct PoseEdge {
    std::size_t a = 0, b = 0;
    Eigen::Isometry3d T_b_a;
    align::TwistFrame frame;        ///< in b's frame, mm
    align::TwistMatrix information; ///< 1/mm²; motions that the pair does not determine have eigenvalue 0
};

struct PoseGraph {
    std::vector<Eigen::Isometry3d> T_world_scan; ///< in: the start; out: the solution
    std::vector<align::TwistFrame> frames;       ///< of each scan, in its own frame: the centre of its small motions
    std::vector<PoseEdge> edges;
    std::size_t fixed = 0; ///< scan whose pose is given
};

struct PoseGraphSolution {
    std::vector<Eigen::Isometry3d> T_world_scan;
    /// Covariance of each scan's twist about its own centre, along the axes of the world, mm²; zero for the fixed one.
    /// Nothing if the edges leave a motion undetermined.
    std::optional<std::vector<align::TwistMatrix>> covariances;
    std::vector<double> misfits; ///< of each edge: √(xᵀ information x), in standard deviations
    bool converged = false;
};

/// Poses that fit all edges best (Lu & Milios, Globally consistent range scan alignment, 1997), by Ceres.
/// @param robust_width  of Cauchy's loss, in standard deviations of an edge; 0: least squares
PoseGraphSolution solve_pose_graph(const PoseGraph& graph, double robust_width);

} // namespace fettle::merge
