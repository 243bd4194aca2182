#pragma once

// Arcs of an NC program. Only for nc_program.

#include "machining/cutter_path.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace fettle::machining {

/// A programmed arc between two points.
struct NcArc {
    Eigen::Vector3d from, to; ///< mm
    std::array<int, 3> axes; ///< the two axes of the plane, the second 90° counter-clockwise from the first; its normal
    bool counter_clockwise = false;
    std::optional<double> radius;  ///< R word, mm; negative: the arc longer than a semicircle
    Eigen::Vector2d centre_offset; ///< from the start to the centre in the plane, if there is no radius; mm
};

/// One exact move for a horizontal circular arc, chords (kArcChordTolerance) for any other.
/// @throws InputError, without the line number, if the ends are not on one arc
std::vector<CutterMove> arc_moves(const NcArc& arc);

} // namespace fettle::machining
