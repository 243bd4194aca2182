#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <variant>

namespace fettle {

/// A mesh or a cloud, mm.
using MeshOrCloud = std::variant<Mesh, Cloud>;

struct ShapeFile {
    MeshOrCloud shape;
    Units units; ///< of the file
};

/// Reads a mesh or a cloud, told by content. @param path  "-": stdin
/// @param units  what the file is in; nothing: what a PCD says of itself, else mm
ShapeFile read_shape(const std::string& path, const std::optional<Units>& units);

/// A mesh's vertices, or the cloud with all its fields.
Cloud points_of(const MeshOrCloud& shape);

} // namespace fettle
