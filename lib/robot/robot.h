#pragma once

#include "robot/solid.h"
#include "units/units.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::robot {

/// Angles of the six joints as the robot's own controller counts them, rad.
using Joints = Eigen::Matrix<double, 6, 1>;

/// Tolerance at the ends of a joint range, rad or mm: a pose that was made from joints at an end keeps them in range
/// despite rounding.
inline constexpr double kJointRangeTolerance = 1e-9;

/// A closed interval of a joint, rad (a track's: mm).
struct JointRange {
    double min = 0, max = 0;

    bool contains(double value) const
    {
        return value >= min - kJointRangeTolerance && value <= max + kJointRangeTolerance;
    }
};

/// One row of a Denavit-Hartenberg table, Chen & Wei eq. 1: A = R_z(theta) T_z(d) T_x(a) R_x(alpha), mm and rad, with
/// theta = sign q + offset (but see Coupling).
struct DhRow {
    double alpha = 0, a = 0, d = 0, offset = 0;
    JointRange range;                ///< allowed values of q, rad
    std::optional<double> max_speed; ///< limit of |dq/dt|, rad/s
    double sign = 1;                 ///< -1: the controller counts the joint against the axis
};

/// How the inverse kinematics of an arm are found (robot/arm.h).
enum class ArmKind {
    spherical_wrist, ///< axes 2 and 3 parallel, 4 to 6 through one point: closed form, up to eight branches (Pieper
                     ///< 1968)
    parallel_axes,   ///< axes 2, 3 and 4 parallel, as Universal Robots': closed form, up to eight branches
    general          ///< numerically, from many starts: branches may be missing
};

/// Meaning of the controller's joint 3: the angle of the forearm to the upper arm (serial), or, with a parallelogram
/// linkage, to the horizontal: theta3 = q3 - q2 + offset.
enum class Coupling { serial, parallelogram };

/// A linear track that carries the base: joint 7.
struct Track {
    Eigen::Vector3d axis; ///< unit, cell frame
    JointRange range;     ///< mm
    std::optional<double> max_speed;
};

/// A rotary table that carries the workpiece: joint 8. At 0 the part frame is the cell frame.
struct Table {
    Eigen::Vector3d point; ///< a point on the axis, cell frame, mm
    Eigen::Vector3d axis;  ///< unit, cell frame
    JointRange range;      ///< rad, right-handed about the axis
    std::optional<double> max_speed;
    std::string unit; ///< the controller's name of the mechanical unit, for RAPID; may be empty
};

/// Links that a body can be fixed to. Links 1 to 6 are the Denavit-Hartenberg frames behind joints 1 to 6.
namespace link {
inline constexpr int kCell = -1; ///< fixtures, which do not move
inline constexpr int kBase = 0;  ///< the robot's base, on the track if there is one
inline constexpr int kTool = 7;  ///< tip at the origin, +z from the tip to the holder
inline constexpr int kTable = 8;

/// Is a link part of the arm, from its base to its tool?
inline constexpr bool is_on_arm(int link) { return link >= kBase && link <= kTool; }
} // namespace link

/// The frames that the controller of an arm counts in and its programs refer to.
struct ControllerFrames {
    Eigen::Isometry3d T_base_world = Eigen::Isometry3d::Identity(); ///< its world frame, in frame 0 of the table
    Eigen::Isometry3d T_6_flange = Eigen::Isometry3d::Identity();   ///< its flange, from which tools are counted
};

struct Body {
    std::string name;
    int link = link::kCell;
    Solid solid;
};

/// Bound of joint angles in either direction, degrees: no cable survives more than two turns.
inline constexpr double kMaxJointDegrees = 720;

/// Name of the workpiece in robot files and reports; bodies may not use it.
inline constexpr const char* kWorkpieceName = "workpiece";

/// Two bodies by their index in Robot::bodies, the lower one first. The index bodies.size() means the workpiece.
using BodyPair = std::pair<std::size_t, std::size_t>;

/// A robot cell ("kind": "robot"), mm and rad. That of a robot file has a spherical wrist; a URDF's may have any arm of
/// six joints.
struct Robot {
    std::array<DhRow, 6> dh;
    ArmKind arm_kind = ArmKind::spherical_wrist;
    Coupling coupling = Coupling::serial;
    /// Tool frame of the path: the tool's D-H frame, whose z points out of the robot, after half a turn about its x.
    Eigen::Isometry3d T_flange_tool = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d T_cell_base = Eigen::Isometry3d::Identity(); ///< with the track at 0
    std::optional<Track> track;
    std::optional<Table> table;
    std::vector<Body> bodies;
    std::vector<BodyPair> allowed; ///< pairs that may touch

    /// Required minimum distance of a pair.
    struct Margin {
        BodyPair pair;
        double distance; ///< mm
    };
    std::vector<Margin> margins; ///< 0 for pairs that are not listed
    /// The robot holds the workpiece: the part's frame is the tool's D-H frame, the tool frame of a path after half a
    /// turn about its x, as belt::held_part_path() has it.
    bool holds_workpiece = false;
    /// Nothing: a robot file's, whose table begins at the controller's base and ends at its flange.
    std::optional<ControllerFrames> controller;
    std::string no_controller;      ///< of a URDF: why the controller's frames are unknown; empty if they are not
    std::vector<std::string> notes; ///< what a user should know of how the file was read
    std::string digest; ///< SHA-256 of the file and the points of its meshes: by it a checked path knows its robot
};

struct UrdfOptions;

/// Reads a robot file ("-": stdin). Hulls are read from mesh files in the same folder.
/// @throws InputError with the key's path, also for an arm whose inverse kinematics have no closed form, and for a URDF
Robot read_robot(const std::string& path);
/// Reads a robot file or a URDF (urdf.h); the content decides which. @throws InputError as both
Robot read_robot(const std::string& path, const UrdfOptions& options);

/// Name of the body with that index; bodies.size() gives kWorkpieceName.
std::string body_name(const Robot& robot, std::size_t body);

/// A = R_z(theta) T_z(d) T_x(a) R_x(alpha), Chen & Wei eq. 1; angles in rad, lengths in mm.
Eigen::Isometry3d dh_transform(double theta, double d, double a, double alpha);

} // namespace fettle::robot
