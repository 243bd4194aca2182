#pragma once

#include "robot/avoid_tilts.h"
#include "robot/collision.h"
#include "robot/solve_path.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace fettle {

/// A path after what collided was led around.
struct AvoidedPath {
    PosePath poses;                  ///< N
    FollowedPath path;               ///< N
    CheckedPath checked;             ///< N
    std::vector<PoseChange> changes; ///< N
};

/// Leads a path around its collisions by tilting the tool, and where that is not enough by retreating from the part.
/// Track and table stay as they are. What cannot be solved stays as it was.
///
/// Pose by pose (Chen & Wei, algorithm 1 and 5.3): where a pose collides or is not reached, tilts on cones about the
/// point of contact (robot/tilt.h) are tried, 5 degrees wider from one to the next and 5 degrees apart around each,
/// first those nearest to the tilt of the pose before, up to the largest; then again 0.1 mm farther away, and so on.
/// The first one that is clear, and reached without a jump, is taken.
///
/// Smooth: see tilt_smoothly(). Then, both: ways between clear poses that collide are parted from the workpiece by
/// retreats of their ends.
/// @param before  check_path() of `solved`
/// @param away  3xN, unit, part frame: where a retreat leads
AvoidedPath avoid(const Robot& robot, const Workpiece* workpiece, const SolvedPath& solved, const CheckedPath& before,
                  const Eigen::Matrix3Xd& away, const AvoidOptions& options, const CollisionOptions& collision);

} // namespace fettle
