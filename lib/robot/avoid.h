#pragma once

#include "robot/avoid_tilts.h"
#include "robot/collision.h"
#include "robot/solve_path.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::robot {

/// A path after its collisions were avoided.
struct AvoidedPath {
    cloud::PosePath poses;           ///< N
    FollowedPath path;               ///< N
    CheckedPath checked;             ///< N
    std::vector<PoseChange> changes; ///< N
};

/// Avoids the collisions of a path by tilting the tool, and where that is not enough by retreating from the part. Track
/// and table keep their values. Poses for which nothing is found keep their place.
///
/// Pose by pose (Chen & Wei, algorithm 1 and 5.3): where a pose collides or is not reached, tilts on cones about the
/// pivot (robot/tilt.h) are tried. The cones are 5 degrees apart, and so are the tilts on each, those nearest to the
/// tilt of the pose before first; after the largest cone the same with a retreat of 0.1 mm, and so on. The first change
/// that is free of collisions and reached without a jump is taken.
///
/// Smooth: see tilt_smoothly(). In both cases motions between collision-free poses that collide with the workpiece are
/// then freed by retreats of the two poses.
/// @param before  check_path() of `solved`
/// @param retreat_directions  3xN, unit, part frame
AvoidedPath avoid_collisions(const Robot& robot, const Workpiece* workpiece, const SolvedPath& solved,
                             const CheckedPath& before, const Eigen::Matrix3Xd& retreat_directions,
                             const AvoidOptions& options, const CollisionOptions& collision);

} // namespace fettle::robot
