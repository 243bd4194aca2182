#pragma once

#include "cloud/cloud.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::cloud {

/// Vertices and faces of a PLY file, in the units of the file.
struct Ply {
    Cloud vertices; ///< scalar properties are fields: scalar_NAME (written by CloudCompare) is NAME, nx ny nz are
                    ///< normals, red green blue of a byte each are rgb
    std::vector<std::uint32_t> corners; ///< of all faces, one after the other: indices of `vertices`, in range
    std::vector<std::size_t> ends;      ///< end of each face in `corners`
};

/// Parses ascii, binary_little_endian and binary_big_endian. Elements other than vertex and face are checked and
/// skipped. Every count is checked against the size of the file before memory is allocated.
/// @throws InputError with the line or the element
Ply parse_ply(std::string_view bytes, const std::string& source);

/// True if the file begins with the line "ply".
bool looks_like_ply(std::string_view bytes);

/// True if the header declares at least one face; false for anything but a PLY header.
bool ply_has_faces(std::string_view bytes);

} // namespace fettle::cloud
