#pragma once

#include "mesh/box_tree.h"
#include "mesh/mesh_index.h"

#include <optional>

namespace fettle::mesh {

/// MeshIndex::cast() by branch and bound. @param tree  of the mesh
std::optional<MeshIndex::Hit> first_hit(const BoxTree& tree, const Mesh& mesh, const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& unit_direction);

} // namespace fettle::mesh
