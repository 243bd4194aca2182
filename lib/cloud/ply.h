#pragma once

#include "cloud/cloud.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// What a PLY file holds, in the units of the file: its vertices with their scalar properties, and its faces.
struct Ply {
    Cloud vertices; ///< property scalar_NAME (as CloudCompare writes it) is field NAME; nx ny nz are the normals
    std::vector<std::uint32_t> corners; ///< of all faces, one after the other; columns of `vertices`, in range
    std::vector<std::size_t> ends;      ///< end of each face in `corners`
};

/// Reads ascii, binary_little_endian and binary_big_endian. Elements other than vertex and face are checked and
/// skipped. Every count is held against the bytes that are there before anything is allocated.
/// @throws InputError with the line or the element
Ply parse_ply(std::string_view bytes, const std::string& source);

/// Does the text begin with the line "ply"?
bool looks_like_ply(std::string_view bytes);

/// Does the header declare at least one face? False for anything that is no PLY header.
bool ply_has_faces(std::string_view bytes);

} // namespace fettle
