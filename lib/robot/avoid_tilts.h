#pragma once

#include "robot/avoid_trial.h"

#include <cstddef>
#include <numbers>
#include <vector>

namespace fettle {

struct AvoidOptions {
    bool smooth = false;                     ///< else pose by pose
    double most_tilt = std::numbers::pi / 4; ///< rad (Chen & Wei, 5.3)
    double most_retreat = 1;                 ///< mm: Chen & Wei go on for ever
    double jump = std::numbers::pi / 6;      ///< as FollowOptions
};

/// A retreat goes by such steps, mm (Chen & Wei, 5.3).
inline constexpr double kRetreatStep = 0.1;

/// How the poses of a path are changed, and the joints that go with it.
struct Led {
    std::vector<PoseChange> changes; ///< N
    CellJointsPath joints;           ///< N; NaN: not reached
};

/// Chen & Wei's algorithm 1, see avoid().
/// @param trouble  N: must it be led around?
void tilt_by_pose(const Trials& trials, const std::vector<bool>& trouble, const AvoidOptions& options, Led& led);

/// Tilts t of a whole path with the least sum of |t_i - t_i-1|² + |t_i|² / kRamp², by dynamic programming: so the tool
/// begins to lean some kRamp poses before it must. First every sixteenth pose has a say (of sixteen that one which
/// collides deepest), with tilts 7.5 degrees apart; then every eighth, fourth, second and at last each, with tilts ever
/// closer together around those found so far. Only those that lie on a shortest way are tried, until it is clear.
/// Where none is clear tilt_by_pose() has its turn.
/// @param depth  N: how deep each pose collides, mm; 0: it does not; infinite: it is not reached
void tilt_smoothly(const Trials& trials, const std::vector<double>& depth, const AvoidOptions& options, Led& led);

} // namespace fettle
