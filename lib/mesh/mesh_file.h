#pragma once

#include "mesh/mesh.h"
#include "units/units.h"

#include <iosfwd>
#include <string>
#include <string_view>

namespace fettle::core {
class InputFile;
}

namespace fettle::mesh {

/// Reads a mesh from STL (binary or ASCII), PLY, OBJ, OFF or 3MF; size and content decide which. Equal vertices of an
/// STL are merged and numbered in order of appearance; polygons are triangulated.
/// @param path  a file, or "-" for stdin
/// @param unit  length unit of the file; a 3MF states its own
/// @param repair  receives what was dropped or repaired, unless null
/// @return  mm
/// @throws InputError for a malformed file, with the location, and for a mesh without triangles
Mesh read_mesh(const std::string& path, units::Units::Length unit = units::Units::Length::mm,
               MeshRepair* repair = nullptr);
/// Reads a mesh from an open file. @param source  its name for messages
Mesh read_mesh(const core::InputFile& file, const std::string& source, units::Units::Length unit,
               MeshRepair* repair = nullptr);
/// Reads a mesh from the bytes of a file.
Mesh parse_mesh(std::string_view bytes, const std::string& source, units::Units::Length unit = units::Units::Length::mm,
                MeshRepair* repair = nullptr);

/// Writes binary STL; its header names the unit.
void write_stl(std::ostream& out, const Mesh& mesh, units::Units::Length unit = units::Units::Length::mm);

/// True if the content is a point cloud (PCD, PLY without faces, E57, PTX or XYZ text) rather than a mesh.
bool looks_like_cloud(std::string_view bytes);

} // namespace fettle::mesh
