#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "robot/collision_study.h"
#include "robot/robot.h"

#include <optional>
#include <string>
#include <string_view>

namespace fettle::robot {

/// What a checked path says of itself, in the header of its file: "checked DIGEST clearance D between D strokes D
/// part DIGITS".
struct PathStamp {
    std::string digest;   ///< stamp_digest() of the path that was checked
    double clearance = 0; ///< minimum at the poses, mm
    double between = 0;   ///< minimum on the motions between poses, a lower bound, mm
    std::optional<double>
        strokes;      ///< minimum from stroke to stroke, on the travel off the part, mm; nothing: no travel
    std::string part; ///< part_digest() of the part it was checked against
};

/// SHA-256 of the robot; for each point, its place, quaternion, joints, stroke and motion; and what the stamp says of
/// the check.
/// @param mm  in the length unit of the file, whose float coordinates count
/// @throws InputError if the path has no joints
std::string stamp_digest(const Robot& robot, const cloud::Cloud& path, double mm, std::string_view said);

/// The first digits of the SHA-256 of a mesh's vertices and triangles.
std::string part_digest(const mesh::Mesh& part);

/// Minimum clearance on the travel from stroke to stroke, at its poses and between them, mm; nothing without a travel.
/// It is measured at steps of a quarter of CollisionOptions::resolution, since the bounds of check_path() are no closer
/// than it takes to rule out a collision.
std::optional<double> min_travel_clearance(const Robot& robot, const Workpiece* workpiece, const cloud::Cloud& path,
                                           const CollisionStudy& study);

/// Why a path that is free of collisions must not become a program all the same; empty: nothing speaks against it. It
/// was not checked against a workpiece or not against all of its triangles, or nothing of the robot was that comes near
/// it; or a program, which moves the tip straight
/// from pose to pose, would leave the motion that was checked, on which the joints move evenly, by more than the
/// resolution of the check.
std::string stamp_obstacle(const Robot& robot, const CollisionStudy& study, bool has_workpiece);

/// The text of a stamp, the comment in the header of its file (cloud::Cloud::comment), for a path that holds all fields
/// of set_fields().
/// @param strokes  min_travel_clearance()
std::string stamp_text(const Robot& robot, const cloud::Cloud& path, const CheckedPath& checked,
                       const std::optional<double>& strokes, const mesh::Mesh& part, double mm);

/// The stamp of a path that was checked with this robot and has not changed since.
/// @throws InputError that says why a path has none
PathStamp read_stamp(const Robot& robot, const cloud::Cloud& path, double mm);

} // namespace fettle::robot
