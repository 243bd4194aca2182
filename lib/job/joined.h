#pragma once

#include "job/boundary.h"

namespace fettle::job {

/// The outer edge of what either of two polygons that overlap contains, counter-clockwise; of pieces that are apart,
/// that of the largest.
Polygon joined(const Polygon& a, const Polygon& b);

} // namespace fettle::job
