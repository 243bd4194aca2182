#pragma once

#include "core/progress.h"
#include "robot/cell.h"

#include <cstddef>
#include <vector>

namespace fettle::robot {

/// Minimum clearances along a path of N poses.
struct CheckedPath {
    std::vector<CellClearance> at_poses; ///< N, at the poses
    /// N, on the motion from the pose before, joints moving linearly: a lower bound, or, if something collides, the
    /// clearance that was measured. NaN for the first pose and where one of the two poses is not reached.
    std::vector<CellClearance> between_poses;
    std::size_t midpoint_count = 0; ///< configurations measured between poses
};

/// Clearances of the arm, the tool, fixtures and the workpiece at the poses of a path and between them.
/// If two bodies move against each other by no more than m between two configurations (Cell::relative_motion_bound),
/// and have clearances c0 and c1 there, the clearance between is at least (c0 + c1 - m) / 2. Where this leaves a
/// collision possible the motion is bisected, down to the resolution: no overlap deeper than tolerance + resolution / 2
/// is missed (adaptive bisection as Schwarzer, Saha & Latombe 2005). Bodies far apart are decided about by few
/// configurations, however far they move.
/// @param joints  as FollowedPath::joints; NaN columns have no clearances
CheckedPath check_path(const Robot& robot, const Workpiece* workpiece, const CellJointsPath& joints,
                       const CollisionOptions& options, const core::Progress& progress = {});

} // namespace fettle::robot
