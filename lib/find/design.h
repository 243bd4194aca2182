#pragma once

#include "find/verification.h"

namespace fettle::find {

/// True for a region with a flat top and the outline of a rectangle or an ellipse.
bool looks_designed(const Verified& find);

/// Whether two regions have flat tops, one height and about one size, and are high enough to compare. Bosses, pins
/// and pads by design come in such patterns; anomalies hardly ever do.
bool are_alike(const Verified& a, const Verified& b);

} // namespace fettle::find
