#include "robot/mesh_body.h"

#include "robot/hull_points.h"

#include <utility>

namespace fettle::robot {

MeshBody::MeshBody(mesh::Mesh triangles) : mesh(std::move(triangles)), surface(mesh), hull(hull_points(mesh.vertices))
{
}

} // namespace fettle::robot
