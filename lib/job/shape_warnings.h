#pragma once

#include "mesh/cloud_mesh.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <string>
#include <vector>

namespace fettle::job {

/// Warnings about a mesh or a cloud that was read: what was left out of it, and a size that is hardly meant.
/// @param name   of the file, for messages
/// @param units  in which the size is stated
std::vector<std::string> shape_warnings(const mesh::ShapeFile& file, const std::string& name,
                                        const units::Units& units);
/// Likewise, in the units of the file.
std::vector<std::string> shape_warnings(const mesh::CloudMeshFile& file, const std::string& name);

/// Likewise, of a mesh.
std::vector<std::string> shape_warnings(const mesh::Mesh& mesh, const mesh::MeshRepair& repair, const std::string& name,
                                        const units::Units& units);

} // namespace fettle::job
