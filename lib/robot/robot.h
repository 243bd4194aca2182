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

namespace fettle {

/// Angles of the six joints as the robot's own controller counts them, rad.
using Joints = Eigen::Matrix<double, 6, 1>;

/// A closed interval: rad, of a track mm.
struct JointRange {
    double least = 0, most = 0;

    bool holds(double value) const { return value >= least && value <= most; }
};

/// One row of a Denavit-Hartenberg table, Chen & Wei eq. 1: A = R_z(theta) T_z(d) T_x(a) R_x(alpha), mm and rad, with
/// theta = q + offset (but see Coupling).
struct DhRow {
    double alpha = 0, a = 0, d = 0, offset = 0;
    JointRange range;                ///< of q
    std::optional<double> max_speed; ///< of q, rad/s
};

/// What the controller calls joint 3: the angle of the forearm to the upper arm (serial), or, with a parallelogram
/// linkage, to the horizon: theta3 = q3 - q2 + offset.
enum class Coupling { serial, parallelogram };

/// A linear track that carries the base: joint 7.
struct Track {
    Eigen::Vector3d axis; ///< unit, cell frame
    JointRange range;     ///< mm
    std::optional<double> max_speed;
};

/// A rotary table that carries the workpiece: joint 8. At 0 the part frame is the cell frame.
struct Table {
    Eigen::Vector3d point; ///< on the axis, cell frame, mm
    Eigen::Vector3d axis;  ///< unit, cell frame
    JointRange range;      ///< rad, right-handed about the axis
    std::optional<double> max_speed;
    std::string unit; ///< the controller's name for it, for RAPID; may be empty
};

/// What a body is fixed to. 1 to 6 are the frames behind these joints (Denavit-Hartenberg).
namespace link {
inline constexpr int kCell = -1; ///< fixtures
inline constexpr int kBase = 0;  ///< of the robot, on the track
inline constexpr int kTool = 7;  ///< tip at the origin, +z from the tip to the holder
inline constexpr int kTable = 8;
} // namespace link

struct Body {
    std::string name;
    int link = link::kCell;
    Solid solid;
};

/// No joint turns farther, either way: no cable follows more than twice round.
inline constexpr double kMostJointDegrees = 720;

/// How robot files call what is machined; no body may be called so.
inline constexpr const char* kWorkpiece = "workpiece";

/// Two bodies, by their numbers, the lower one first; the number after the last one is the workpiece's.
using BodyPair = std::pair<std::size_t, std::size_t>;

/// A robot cell ("kind": "robot"), mm and rad. The arm has a spherical wrist and parallel axes 2 and 3, so that its
/// inverse has a closed form (robot/arm.h).
struct Robot {
    std::string source = "robot"; ///< the file's name, for messages
    std::array<DhRow, 6> dh;
    Coupling coupling = Coupling::serial;
    /// The path's tool frame: the tool's D-H frame, whose z points out of the robot, turned half about its x.
    Eigen::Isometry3d T_flange_tool = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d T_cell_base = Eigen::Isometry3d::Identity(); ///< with the track at 0
    std::optional<Track> track;
    std::optional<Table> table;
    std::vector<Body> bodies;
    std::vector<BodyPair> allowed; ///< pairs that may touch

    /// Least distances asked for; of all other pairs 0. mm
    struct Margin {
        BodyPair pair;
        double distance;
    };
    std::vector<Margin> margins;
};

/// Reads a robot file ("-": stdin). Hulls are read from mesh files beside it.
/// @throws InputError with the key's path: also for an arm whose inverse has no closed form
Robot read_robot(const std::string& path);

/// Of a body by its number, or kWorkpiece.
std::string body_name(const Robot& robot, std::size_t body);

/// A = R_z(theta) T_z(d) T_x(a) R_x(alpha), Chen & Wei eq. 1.
Eigen::Isometry3d dh_transform(double theta, double d, double a, double alpha);

} // namespace fettle
