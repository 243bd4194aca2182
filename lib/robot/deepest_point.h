#pragma once

#include "robot/clearance.h"

namespace fettle::robot {

/// The deepest point of a triangle in a body becomes `best` if it is deeper, by cutting planes (Kelley 1960): the
/// signed distance is convex, so that each of its tangent planes bounds it from below on the whole triangle. Where the
/// body is bounded by planes these are its sides, and a few suffice.
/// @param best  a is the body, b the triangle
/// @return  has it become so?
bool find_deepest(const PlacedSolid& body, const mesh::Triangle& triangle, Clearance& best);

} // namespace fettle::robot
