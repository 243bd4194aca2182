#pragma once

#include "robot/clearance.h"
#include "robot/simplex.h"

namespace fettle::robot {

/// Penetration depth of two overlapping cores by the expanding polytope algorithm (van den Bergen 2001): the shortest
/// translation that separates them.
/// @param around_origin  a simplex of their Minkowski difference that contains or touches the origin
/// @return  the depth as a negative distance
Clearance core_depth(const PlacedSolid& a, const PlacedSolid& b, const Simplex& around_origin);

} // namespace fettle::robot
