#pragma once

#include "mesh/cloud_mesh.h"

namespace fettle::find {

/// Joins a laser profiler's points to triangles, if their profiles lie much farther apart than the points of each: a
/// height map of the points alone has the coarse spacing in both directions. All points remain, in their order; those
/// of no triangle (reflections, what lies beneath an overhang) are not searched. Any other part stays as it is.
/// @return  whether it has triangles now
bool join_profiles(mesh::CloudMesh& part);

} // namespace fettle::find
