#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace fettle {

class InputFile;

/// A part as points or as triangles, mm.
using MeshOrCloud = std::variant<Cloud, Mesh>;

struct ShapeFile {
    MeshOrCloud shape;
    Units units;       ///< of the file
    MeshRepair repair; ///< what reading a mesh dropped
};

/// Reads a mesh or a cloud, told by content.
/// @param path   a file, or "-" for stdin
/// @param units  what the file is in; nothing: what a PCD says of itself, else mm
/// @throws InputError as read_mesh() and read_cloud()
ShapeFile read_shape(const std::string& path, const std::optional<Units>& units);
/// The same from an open file, or from bytes. @param source  its name for messages
ShapeFile read_shape(const InputFile& file, const std::string& source, const std::optional<Units>& units);
ShapeFile parse_shape(std::string_view bytes, const std::string& source, const std::optional<Units>& units);

/// What a file is in, for read_shape(): the stated length with the other units of `otherwise`, or those alone.
std::optional<Units> units_of(const std::optional<Units::Length>& stated,
                              const std::optional<Units>& otherwise = std::nullopt);

/// Where its points or its vertices are, 3xN, mm.
const Eigen::Matrix3Xd& places_of(const MeshOrCloud& shape);

} // namespace fettle
