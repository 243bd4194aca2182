#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle::removal {

/// Does a triangle show its front to somebody above it? True for a vertical one, too.
bool faces_up(const mesh::Mesh& mesh, Eigen::Index triangle);

/// Is the back of the triangles outside? A scan from above faces up; of another mesh the sign of its volume says where
/// it is, even if a part of it is missing.
bool is_inside_out(const mesh::Mesh& mesh);

/// Do neighbours run along their common edge in opposite directions? If they do not, or if the triangles share no
/// vertices, front and back mean nothing.
bool has_consistent_winding(const mesh::Mesh& mesh);

} // namespace fettle::removal
