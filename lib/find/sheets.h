#pragma once

#include "find/height_map.h"

#include <vector>

namespace fettle::find {

/// A large smooth piece of a part between creases, steps and borders.
struct Sheet {
    Mask smooth; ///< its own cells
    Mask domain; ///< them, what they enclose, and what lies beside within reach: where its anomalies may stand
};

/// Cuts a height map where its normals turn faster than within sheets, and keeps the large pieces, largest first.
/// @param reach  how far beside a sheet its anomalies may stand, cells
std::vector<Sheet> find_sheets(const HeightMap& map, double reach);

} // namespace fettle::find
