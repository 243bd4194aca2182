#pragma once

#include "find/height_map.h"

#include <vector>

namespace fettle::find {

/// A large smooth piece of a part between creases, steps and borders.
struct Sheet {
    Mask smooth; ///< its own cells
    Mask domain; ///< its own cells, those they enclose, and those within reach: where its anomalies may lie
};

/// Segments a height map where its normals turn faster than within sheets, and keeps the large pieces, largest first.
/// @param reach  maximum distance of an anomaly from its sheet, cells
std::vector<Sheet> find_sheets(const HeightMap& map, double reach);

} // namespace fettle::find
