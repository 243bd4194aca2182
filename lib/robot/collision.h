#pragma once

#include "core/progress.h"
#include "robot/arm.h"
#include "robot/externals.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace fettle {

/// Two bodies of a cell that are held against each other; `b` is the robot's number of bodies for the workpiece.
struct CellPair {
    std::size_t a, b;
    double margin = 0; ///< they must stay that far apart, mm
};

/// All pairs but those of bodies on one link or on neighbouring links, that never move against each other, or that the
/// robot file allows. The workpiece lies on the table, or in the cell if there is none.
std::vector<CellPair> checked_pairs(const Robot& robot);

struct CollisionOptions {
    double tolerance =
        0.01;           ///< what goes no deeper is a contact, no collision, mm (Chen & Wei: the accuracy of machining)
    double beyond = 50; ///< clearances are told up to here, mm
    double resolution =
        0.1; ///< between poses the bodies move no farther from one look to the next, mm, where it matters
};

/// The least clearance of a cell, its margin taken off.
struct CellClearance {
    double clearance = std::numeric_limits<double>::quiet_NaN(); ///< mm; NaN: not looked at
    std::size_t pair = 0;                                        ///< of checked_pairs()
    Eigen::Vector3d point =
        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< on body a, cell frame
};

struct CheckedPath {
    std::vector<CellClearance> pose; ///< N
    /// N: the least on the way from the pose before, joints moving evenly: a lower bound, or, if something collides,
    /// what was seen of it. The first is NaN, and where one of the two poses is not reached.
    std::vector<CellClearance> between;
    std::size_t looks = 0; ///< between poses
};

/// Clearances of the arm, the tool, fixtures and the workpiece at the poses of a path and between them.
/// Between two looks no point of a body moves farther than its chord + (sum of the joints' turns)² R / 2, R being its
/// distance from their axes: clearances c0 and c1 then leave at least (c0 + c1 - that way) / 2. Where this is not
/// enough the way is halved, down to the resolution: so nothing deeper than tolerance + resolution / 2 is missed.
/// @param joints  as FollowedPath::joints: NaN columns are not looked at
CheckedPath check_path(const Robot& robot, const Workpiece* workpiece, const CellJointsPath& joints,
                       const CollisionOptions& options, const Progress& progress = {});

/// Where the frame of each link stands, by link + 1 (robot.h: cell, base, 1 to 6, tool, table).
std::vector<Eigen::Isometry3d> link_frames(const Robot& robot, const CellJoints& joints);

} // namespace fettle
