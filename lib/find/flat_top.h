#pragma once

#include "find/image.h"

namespace fettle::find {

/// How far the top of a region departs from a plane: the median distance of its cells from the plane that the nearer
/// half of them fits best, mm; infinite for a few cells. Walls, holes and a second level may take the other half.
/// @param height  over the surface beneath   @param z  of what is seen
double departure_from_plane(const Mask& region, const Image& height, const Image& z);

} // namespace fettle::find
