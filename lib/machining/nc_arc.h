#pragma once

// Arcs of a machine program. Only for nc_program.

#include "machining/cutter_path.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace fettle {

/// An arc as it is programmed, from one point to another.
struct NcArc {
    Eigen::Vector3d from, to; ///< mm
    std::array<int, 3> axes;  ///< of the plane, the second a quarter turn after the first; then that across it
    bool counter_clockwise = false;
    std::optional<double> radius;  ///< mm; below 0: the arc of more than half a turn
    Eigen::Vector2d centre_offset; ///< from the beginning to the centre, if there is no radius; mm, in the plane
};

/// One exact move for a level arc, else moves along chords (kArcChord).
/// @throws InputError, without the line's number, for ends that are not on one arc
std::vector<CutterMove> moves_along(const NcArc& arc);

} // namespace fettle
