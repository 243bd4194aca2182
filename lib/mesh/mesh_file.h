#pragma once

#include "mesh/mesh.h"
#include "units/units.h"

#include <iosfwd>
#include <string>
#include <string_view>

namespace fettle {

class InputFile;

/// Reads STL (binary or ASCII, told by size and content), PLY, OBJ or OFF. Equal vertices of an STL are made one; the
/// lowest index stays, so the result does not depend on threads. Polygons are cut into triangles.
/// @param path  a file, or "-" for stdin
/// @param unit  of the file
/// @throws InputError for what is malformed, with the place; also for a mesh without triangles
Mesh read_mesh(const std::string& path, Units::Length unit = Units::Length::mm, MeshRepair* repair = nullptr);
/// The same from an open file. @param source  its name for messages
Mesh read_mesh(const InputFile& file, const std::string& source, Units::Length unit, MeshRepair* repair = nullptr);
Mesh parse_mesh(std::string_view bytes, const std::string& source, Units::Length unit = Units::Length::mm,
                MeshRepair* repair = nullptr);

/// Binary STL; the 80 byte header names the unit.
void write_stl(std::ostream& out, const Mesh& mesh, Units::Length unit = Units::Length::mm);

/// Is this content a point cloud (PCD, or PLY without faces, or XYZ text) rather than a mesh?
bool looks_like_cloud(std::string_view bytes);

} // namespace fettle
