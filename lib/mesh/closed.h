#pragma once

#include "mesh/mesh.h"

namespace fettle::mesh {

/// Is each edge of a triangle shared with exactly one other triangle, in the opposite direction? Then the mesh has an
/// inside.
bool is_closed(const Mesh& mesh);

} // namespace fettle::mesh
