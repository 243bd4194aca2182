#pragma once

#include "robot/externals.h"
#include "robot/robot.h"

#include <Eigen/Core>

#include <numbers>
#include <vector>

namespace fettle::robot {

struct FollowOptions {
    Joints start = Joints::Zero();                ///< the path starts with the solution nearest to these, rad
    double jump_threshold = std::numbers::pi / 6; ///< a larger change of a joint between two poses is a jump, rad
};

enum class PoseState {
    reached = 0,
    unreachable = 1,  ///< out of reach of the arm
    out_of_range = 2, ///< every solution has a joint out of its range
    undefined = 3     ///< the pose or the joints are NaN
};

/// Joints along a path of N poses.
struct FollowedPath {
    CellJointsPath joints;               ///< rad and mm; NaN where the pose is not reached
    std::vector<PoseState> state;        ///< N
    std::vector<int> branch;             ///< N, ArmSolution::branch; -1 where the pose is not reached
    Eigen::VectorXd singularity;         ///< N, distance from a singularity (Singularity::min)
    std::vector<Eigen::Index> jumps;     ///< poses with a jump of a joint or the table from the pose before
    std::vector<int> joint_out_of_range; ///< N, index of the joint that puts the pose out of range; -1: none does
    /// N: the value of that joint, rad or mm; where the pose is unreachable the distance of the flange from the base's
    /// origin, mm; else NaN.
    Eigen::VectorXd obstacle_value;
    Eigen::Matrix<Eigen::Index, 8, 1> out_of_range_counts; ///< by joint: number of poses that it puts out of range
};

/// Inverse kinematics along a path: of all sequences of solutions in range, whole turns included, the one with the
/// fewest jumps, and of these the one with the smallest sum of squared joint motions (Viterbi). A pose that is not
/// reached interrupts the path.
/// @param externals  2xN, see external_values()
FollowedPath follow_path(const Robot& robot, const cloud::PosePath& poses, const Eigen::Matrix2Xd& externals,
                         const FollowOptions& options = {});

/// States, distances from singularities and jumps of given joints. Branches are not determined.
/// @param joints  rad and mm; NaN: undefined
/// @param jump_threshold  FollowOptions::jump_threshold, rad
FollowedPath evaluate_joints(const Robot& robot, const CellJointsPath& joints, double jump_threshold);

/// All solutions in range of one pose as (branch, joints), whole turns included, in the order of branches and turns.
std::vector<std::pair<int, Joints>> all_solutions(const Robot& robot, const Eigen::Isometry3d& T_base_flange);

} // namespace fettle::robot
