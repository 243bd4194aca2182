#pragma once

#include "core/progress.h"
#include "robot/cell.h"

#include <cstddef>
#include <vector>

namespace fettle {

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

} // namespace fettle
