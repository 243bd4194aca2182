#pragma once

#include "robot/clearance.h"
#include "robot/simplex.h"

namespace fettle {

/// The shortest shift that parts two overlapping cores, from a simplex of their difference that holds the origin or
/// touches it (van den Bergen 2001).
/// @return  its length as a negative distance
Clearance core_depth(const PlacedSolid& a, const PlacedSolid& b, const Simplex& around_origin);

} // namespace fettle
