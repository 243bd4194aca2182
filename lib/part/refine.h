#pragma once

#include "mesh/mesh.h"
#include "part/profile.h"

#include <vector>

namespace fettle::part {

/// @throws InputError if a part would have more triangles than fit into the memory
void check_triangle_count(double triangles);

/// Resolution of the triangles under anomalies.
struct RefineOptions {
    double step = 1;           ///< longest edge under an anomaly, mm
    double chord_error = 0.02; ///< largest deviation of the profile from the middle of an edge, mm
    double min_edge = 0.05;    ///< shorter edges do not result from halving, mm
};

/// Splits triangles in the x-y plane, so that the mesh represents the anomalies once its vertices are lifted. Sharp
/// edges of the profile become mesh edges; other edges are halved until the chord error is within its bound. New
/// vertices are on the old triangles: the surface itself does not change. The mesh stays conforming; triangles far from
/// every footprint stay.
/// @throws InputError as check_triangle_count()
mesh::Mesh refine(const mesh::Mesh& mesh, const std::vector<Anomaly>& anomalies, const RefineOptions& options);

} // namespace fettle::part
