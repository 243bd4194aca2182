#pragma once

#include "cloud/poses.h"
#include "robot/robot.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>

namespace fettle::robot {

/// Joints 1 to 6 (rad), the track (mm), the table (rad); 0 for an axis that the robot lacks.
using CellJoints = Eigen::Matrix<double, 8, 1>;
/// Joints along a path of N poses, 8xN.
using CellJointsPath = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// Rule for an external axis (track or table) along a path: it stays at `value`, or it follows the tip. A track that
/// follows keeps the base `value` mm behind the tip along its axis, within its range. A table that follows turns the
/// tip to the azimuth `value` (rad) about its axis, counted from the cell's x (from y if the axis is along x).
struct AxisRule {
    bool follows = false;
    double value = 0;
};

/// Parses "auto" (nothing: the rule is to be chosen), a number, or "follow:NUMBER".
/// @param unit  of the number, in rad or mm
/// @throws InputError for anything else
std::optional<AxisRule> parse_axis_rule(const std::string& text, double unit);

/// Rules for the axes that the robot has; nothing: the rule is to be chosen.
struct ExternalRules {
    std::optional<AxisRule> track, table;
};

/// Rules, and how good they are on the path.
struct ExternalChoice {
    AxisRule track, table;
    Eigen::Index unreached = 0; ///< number of evaluated poses without a solution
    Eigen::Index colliding = 0; ///< number of evaluated poses all of whose solutions collide; 0 if nobody checked
    double singularity = 0;     ///< minimum over the poses of the best solution's Singularity::min
};

/// Whether nothing touches what it must not with these joints. Thread-safe.
using IsClear = std::function<bool(const CellJoints& joints)>;

/// Chooses the rules with the fewest poses that have no solution in range, then with the fewest that have none without
/// a collision, then with the fewest axes that follow, then with the largest distance from a singularity. Evaluates a
/// sample of the poses and of the axes' ranges.
/// @param is_clear  empty: collisions do not matter
ExternalChoice choose_externals(const Robot& robot, const cloud::PosePath& poses, const ExternalRules& rules,
                                const IsClear& is_clear = {});

/// Values of track (mm) and table (rad) at each pose, 2xN; NaN where there is no pose. An axis that the robot lacks is
/// 0.
Eigen::Matrix2Xd external_values(const Robot& robot, const cloud::PosePath& poses, const AxisRule& track,
                                 const AxisRule& table);

/// T_cell_base with the track at a position, mm.
Eigen::Isometry3d base_in_cell(const Robot& robot, double track);
/// T_cell_part with the table at an angle, rad.
Eigen::Isometry3d part_in_cell(const Robot& robot, double table);

/// T_base_flange that brings the tool to a pose in the part, with track (mm) and table (rad).
Eigen::Isometry3d flange_target(const Robot& robot, const Eigen::Isometry3d& T_part_tool, double track, double table);

} // namespace fettle::robot
