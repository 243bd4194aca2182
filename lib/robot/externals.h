#pragma once

#include "cloud/poses.h"
#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace fettle {

/// Joints 1 to 6 (rad), the track (mm), the table (rad); 0 for one that the robot lacks.
using CellJoints = Eigen::Matrix<double, 8, 1>;
using CellJointsPath = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// How an axis beyond the arm's six is led along a path: it stands at `value`, or it follows the tip. The track then
/// keeps the base `value` mm behind the tip along its axis, as far as it reaches; the table turns the tip to the
/// azimuth `value` (rad) about its axis, counted from the cell's x (from y if the axis lies along x).
struct AxisRule {
    bool follows = false;
    double value = 0;
};

/// "auto" (nothing: to be chosen), a number, or "follow:NUMBER". @param unit  of the number, rad or mm
/// @throws InputError for anything else
std::optional<AxisRule> parse_axis_rule(const std::string& text, double unit);

/// Rules for the axes that the robot has; nothing: to be chosen.
struct ExternalRules {
    std::optional<AxisRule> track, table;
};

/// Rules, and how good they are over the path.
struct ExternalChoice {
    AxisRule track, table;
    Eigen::Index unreached = 0; ///< of the poses looked at
    double singularity = 0;     ///< the least distance of the best solutions from a singularity (robot/arm.h)
};

/// The rules under which the fewest poses have no solution in range, axes standing still before those that follow,
/// and then those with the greatest least distance from a singularity. Looks at poses spread over the path, and at
/// places spread over the ranges.
ExternalChoice choose_externals(const Robot& robot, const PosePath& poses, const ExternalRules& wanted);

/// Track and table at each pose: 2xN, mm and rad; NaN where there is no pose. An axis that the robot lacks stays at 0.
Eigen::Matrix2Xd external_values(const Robot& robot, const PosePath& poses, const AxisRule& track,
                                 const AxisRule& table);

/// Where the base stands with the track there, mm. @return  T_cell_base
Eigen::Isometry3d cell_base(const Robot& robot, double track);
/// Where the part stands with the table there, rad. @return  T_cell_part
Eigen::Isometry3d cell_part(const Robot& robot, double table);

/// Where the flange must be so that the tool is at a pose in the part. @return  T_base_flange
Eigen::Isometry3d flange_for(const Robot& robot, const Eigen::Isometry3d& T_part_tool, double track, double table);

} // namespace fettle
