#pragma once

#include "robot/externals.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <numbers>
#include <vector>

namespace fettle {

struct FollowOptions {
    Joints start = Joints::Zero();      ///< the path begins with the solution nearest to these
    double jump = std::numbers::pi / 6; ///< more between two poses is no motion along the path, rad
};

enum class PoseState {
    reached = 0,
    unreachable = 1,  ///< beyond the arm's length
    out_of_range = 2, ///< a joint would leave its range
    undefined = 3     ///< NaN
};

/// Joints along a path of N poses.
struct FollowedPath {
    CellJointsPath joints;                     ///< rad and mm; NaN where the pose is not reached
    std::vector<PoseState> state;              ///< N
    std::vector<int> branch;                   ///< N, as ArmSolution; -1 where the pose is not reached
    Eigen::VectorXd singularity;               ///< N, distance from one (Singularity::least)
    std::vector<Eigen::Index> jumps;           ///< poses that lie a jump of a joint or the table from the one before
    Eigen::Matrix<Eigen::Index, 8, 1> blocked; ///< of the poses out of range: which joint is in the way, how often
};

/// The way through all solutions in range, their whole turns included, with the fewest jumps and of these the one with
/// the least sum of squared joint motions: a shortest path (Viterbi). Poses that are not reached part it.
/// @param externals  2xN, as external_values()
FollowedPath follow(const Robot& robot, const PosePath& poses, const Eigen::Matrix2Xd& externals,
                    const FollowOptions& options = {});

/// Joints that are given, judged as a path's: their states, distances from singularities and jumps.
/// @param joints  rad and mm; NaN: undefined
/// @param jump  as FollowOptions
FollowedPath judge(const Robot& robot, const CellJointsPath& joints, double jump);

/// All solutions in range of one pose, in the order of their branches and turns.
std::vector<std::pair<int, Joints>> all_solutions(const Robot& robot, const Eigen::Isometry3d& T_base_flange);

} // namespace fettle
