#pragma once

#include "part/profile.h"
#include "json/document.h"

#include <string>

namespace fettle {

/// The desired surface of a made part: z over x-y, mm; NaN where it is not defined. These closed forms share nothing
/// with fit/ and surface/ on purpose: what is made here is the truth that those are measured against. Reads
///   {"type": "plane", "point": [x, y, z], "slope": [dz/dx, dz/dy]}
///   {"type": "sphere", "centre": [x, y, z], "radius": r, "concave": false}
///   {"type": "cylinder", "point": [x, y, z], "direction_deg": d, "radius": r, "concave": false}
///   {"type": "swept", "point": [x, y, z], "direction_deg": d, "section": [[s, z], …], "slope": 0}
///   {"type": "patches", "file": "patch.json"}
/// @param mm  in one unit of the file   @throws InputError
OverPlane read_part_surface(json::Reader reader, double mm, const std::string& folder);

} // namespace fettle
