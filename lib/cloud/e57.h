#pragma once

#include "cloud/cloud.h"

#include <string>
#include <string_view>

namespace fettle::cloud {

/// Parses an E57 file (ASTM E2807): the points of all its scans, each moved by the pose that the file states, in the
/// file's order. Coordinates may be floats, scaled integers or integers, Cartesian or spherical; points whose flag says
/// that they are invalid become NaN. The checksums of all pages are verified. Fields, where the scans have them:
/// intensity, row, column, normal_x, normal_y, normal_z (NaN where a scan has none), and rgb where all have colours.
/// The viewpoint is the scanner's, if one scan of the file has points and states its pose; several together have none.
/// Pictures and other extensions are left out. The cloud is in metres, as E57 is.
///
/// libE57Format is not in Debian 12, and needs Xerces, which takes as long to load as a tool may take to start.
/// @throws InputError with the place: for a wrong checksum, a section outside of the file, a record that misses, a
/// number outside of the range that its column states
Cloud parse_e57(std::string_view bytes, const std::string& source);

/// True if the file begins as E57 does.
bool looks_like_e57(std::string_view bytes);

} // namespace fettle::cloud
