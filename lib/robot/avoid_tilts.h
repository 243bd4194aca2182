#pragma once

#include "robot/avoid_trial.h"

#include <numbers>
#include <vector>

namespace fettle::robot {

struct AvoidOptions {
    bool smooth = false;                          ///< false: pose by pose
    double max_tilt = std::numbers::pi / 4;       ///< rad (Chen & Wei, 5.3)
    double max_retreat = 1;                       ///< mm; Chen & Wei have no bound
    double jump_threshold = std::numbers::pi / 6; ///< FollowOptions::jump_threshold, rad
};

/// Step of retreats, mm (Chen & Wei, 5.3).
inline constexpr double kRetreatStep = 0.1;

/// The changes of a path's poses, with the joints of the changed poses.
struct ChangedPath {
    std::vector<PoseChange> changes; ///< N
    CellJointsPath joints;           ///< N; NaN: not reached
};

/// Chen & Wei's algorithm 1, see avoid().
/// @param must_change  N: the poses that collide or are not reached
/// @param path  input and output
void tilt_by_pose(const ChangeChecker& trials, const std::vector<bool>& must_change, const AvoidOptions& options,
                  ChangedPath& path);

/// Finds the tilts t of a path that minimise the sum of |t_i - t_i-1|² + |t_i|² / kRampPoses² without a collision, by
/// dynamic programming: the tool begins to tilt some kRampPoses poses before it must. The search goes from coarse to
/// fine: first with one pose of each sixteen (the one that collides deepest) and tilts 7.5 degrees apart, then with one
/// of eight, four, two and at last each pose, with tilts ever closer together around those found before. Only tilts on
/// an optimal path are checked for collisions, until one is free of them. Poses where this fails are left to
/// tilt_by_pose().
/// @param depth  N: penetration depth of each pose, mm; 0: it does not collide; infinite: it is not reached
/// @param path  input and output
void tilt_smoothly(const ChangeChecker& trials, const std::vector<double>& depth, const AvoidOptions& options,
                   ChangedPath& path);

} // namespace fettle::robot
