#pragma once

#include "mesh/mesh.h"
#include "units/units.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace fettle {

/// Is the size that of a binary STL with as many triangles as bytes 80 to 83 say? Nothing else is looked at: the
/// header of a binary file may well begin with "solid".
bool is_binary_stl(std::string_view bytes);
/// The same from the beginning of a file of `size` bytes; so many of them tell.
inline constexpr std::size_t kStlHead = 84;
bool is_binary_stl(std::string_view head, std::size_t size);

/// Does the text begin like an ASCII STL: "solid", in any case, and somewhere "facet" or "endsolid"?
bool looks_like_ascii_stl(std::string_view bytes);

/// Binary or ASCII STL, in the units of the file. Triangles with NaN or infinite corners are left out and counted;
/// exactly equal vertices are made one.
/// @throws InputError with the line, the triangle, or the sizes that disagree
Mesh parse_stl(std::string_view bytes, const std::string& source, MeshRepair& repair);

/// The same of a binary STL that is read piece by piece.
/// @param head  of a file for which is_binary_stl() holds
/// @param read  copies `count` bytes of the file from `offset` on; called by several threads at once
using ReadBytes = std::function<void(std::size_t offset, char* to, std::size_t count)>;
Mesh read_binary_stl(std::string_view head, const ReadBytes& read, const std::string& source, MeshRepair& repair);

/// A binary STL by parts, for what is too large to be held as a mesh: the bytes before the triangles, which name the
/// unit, then those of the triangles.
inline constexpr std::size_t kStlTriangle = 12 * 4 + 2; // normal, three corners, attribute
std::string stl_header(std::size_t triangles, Units::Length unit);
/// @param to  room for kStlTriangle bytes a triangle
void put_stl_triangles(const Mesh& part, Units::Length unit, char* to);

} // namespace fettle
