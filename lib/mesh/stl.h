#pragma once

#include "mesh/mesh.h"
#include "units/units.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace fettle::core {
class InputFile;
}

namespace fettle::mesh {

/// Bytes of a binary STL before its triangles: 80 bytes of free text and the number of triangles.
inline constexpr std::size_t kStlHeaderBytes = 84;
/// Bytes of a triangle: normal, three corners, attribute.
inline constexpr std::size_t kStlTriangleBytes = 12 * 4 + 2;

/// True if the size is that of a binary STL with the number of triangles in bytes 80 to 83. The text before it does not
/// matter: in a binary file it may well begin with "solid".
bool is_binary_stl(std::string_view bytes);
/// @param head  at least the first kStlHeaderBytes bytes of a file   @param size  of the file
bool is_binary_stl(std::string_view head, std::size_t size);
/// First kStlHeaderBytes bytes of a binary STL; empty for another file.
std::string read_binary_stl_header(const core::InputFile& file);

/// True if bytes that are not a binary STL by their size were meant as one: cut off, miscounted, or in big-endian
/// order. Most of the first facets then have corners of a plausible size, which other data has not.
bool looks_like_damaged_stl(std::string_view bytes);

/// True if the text begins like an ASCII STL: with "solid", in any case, and soon "facet" or "endsolid".
bool looks_like_ascii_stl(std::string_view bytes);

/// Parses binary or ASCII STL, in the units of the file. Triangles with NaN or infinite corners are dropped and exactly
/// equal vertices merged; `repair` counts both.
/// @throws InputError with the line, the triangle, or the sizes that disagree
Mesh parse_stl(std::string_view bytes, const std::string& source, MeshRepair& repair);

/// Reads a binary STL piece by piece, without holding the whole file in memory.
/// @param head  first bytes of a file for which is_binary_stl() holds
/// @param read  copies `count` bytes of the file from `offset` on; called by several threads at once
using ByteReader = std::function<void(std::size_t offset, char* to, std::size_t count)>;
Mesh read_binary_stl(std::string_view head, const ByteReader& read, const std::string& source, MeshRepair& repair);

/// The kStlHeaderBytes bytes before the triangles of a binary STL; their text names the unit, and the job's frame. With
/// encode_stl_triangles() it writes meshes that do not fit into memory.
std::string make_stl_header(std::size_t triangles, units::Units::Length unit, cloud::Frame frame = cloud::Frame::part);
/// Encodes triangles as binary STL. @param to  memory for kStlTriangleBytes bytes per triangle
void encode_stl_triangles(const Mesh& part, units::Units::Length unit, char* to);

} // namespace fettle::mesh
