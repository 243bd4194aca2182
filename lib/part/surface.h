#pragma once

#include "part/profile.h"
#include "json/document.h"

#include <string>

namespace fettle::part {

/// Reads the desired surface of a synthetic part: z over x-y, mm; NaN where it is not defined. These closed forms share
/// no code with fit/ on purpose: they are the ground truth for it. Of surface/ they use patches and the basis functions
/// of B-splines, whose reference is Eigen's in tests/bench/libraries_bench.cc. The formats are
///   {"type": "plane", "point": [x, y, z], "slope": [dz/dx, dz/dy]}
///   {"type": "sphere", "centre": [x, y, z], "radius": r, "concave": false}
///   {"type": "cylinder", "point": [x, y, z], "direction_deg": d, "radius": r, "concave": false}
///   {"type": "swept", "point": [x, y, z], "direction_deg": d, "section": [[s, z], …], "slope": 0}
///   {"type": "patches", "file": "patch.json"}
/// @param mm  mm per unit of the file   @param folder  of the specification, for patches   @throws InputError
ScalarField2d read_part_surface(json::Reader reader, double mm, const std::string& folder);

} // namespace fettle::part
