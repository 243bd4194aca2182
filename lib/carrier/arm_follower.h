#pragma once

#include "cloud/poses.h"
#include "robot/arm.h"
#include "robot/solve_path.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace fettle::carrier {

/// The joints of a robot that carries the wheel as the head of a gantry does: upright in the job's frame, its axis at
/// θ. They follow the tool point on one branch of the inverse kinematics, continuously; a table stands still.
class ArmFollower {
  public:
    /// Chooses the place of track and table, and the branch, so that all points are reached one after the other. What
    /// the arm then hits in its cell is refused; the part is not looked at.
    /// @param T_cell_job  of the job's frame in the cell, with the table at 0; mm   @param theta  of the wheel's axis
    /// @param points  of the tool, in the job's frame, no farther apart than a joint may turn at once; the first one is
    /// where the robot stands then
    /// @throws GantryFault that names the first point that is not reached, the joint and its value, or the two bodies
    ArmFollower(const robot::Robot& robot, const robot::PathArguments& arguments, const Eigen::Isometry3d& T_cell_job,
                double theta, const std::vector<Eigen::Vector3d>& points);

    /// Joints for a tool point next to that of `from`, on its branch, from which no joint jumps.
    /// @throws GantryFault that names the point, the joint and its value
    robot::CellJoints joints_at(const Eigen::Vector3d& tool_point, const robot::CellJoints& from) const;
    /// Joints at the first of the points.
    const robot::CellJoints& start() const { return start_; }
    const robot::ExternalChoice& externals() const { return externals_; }
    /// Pose of the tool in the part's frame of a path: the cell's, with the table at 0.
    Eigen::Isometry3d pose_at(const Eigen::Vector3d& tool_point) const;

    /// Time that the joints need at least from one place to the other at the robot's speeds, s; 0 if it gives none.
    double min_duration(const robot::CellJoints& from, const robot::CellJoints& to) const;

  private:
    void choose(const robot::PathArguments& arguments, const std::vector<Eigen::Vector3d>& points);
    std::string obstacle_abreast(robot::PathArguments arguments, const cloud::Cloud& poses,
                                 const std::vector<Eigen::Vector3d>& points, double table) const;
    void check_clearance(const robot::CellJointsPath& joints, const std::vector<Eigen::Vector3d>& points) const;
    void check_range(const Eigen::Vector3d& tool_point, Eigen::Index joint, double value) const;

    const robot::Robot& robot_;
    robot::Arm arm_;
    Eigen::Isometry3d T_cell_job_;
    Eigen::Matrix3d R_job_tool_; ///< +x in the wheel's plane, +z up
    double jump_threshold_;      ///< rad
    robot::ExternalChoice externals_;
    robot::CellJoints start_;
};

} // namespace fettle::carrier
