#pragma once

#include "mesh/mesh.h"
#include "part/profile.h"

#include <vector>

namespace fettle {

/// @throws InputError for more triangles than a part may have: they would fill the memory
void check_size(double triangles);

/// How finely the triangles under anomalies are to follow the profile.
struct Refinement {
    double step = 1;     ///< longest edge under an anomaly, mm
    double chord = 0.02; ///< height of the profile over the middle of an edge, mm
    double least = 0.05; ///< edges are not halved below it, mm
};

/// Splits triangles, in x-y, so that the profile is represented once the vertices are lifted by it: sharp edges become
/// mesh edges, elsewhere edges are halved until the chord error is met. New vertices lie on the old triangles: the
/// surface itself does not change. Neighbours stay matched; a triangle far from every footprint stays as it is.
/// @throws InputError as check_size()
Mesh refine(const Mesh& mesh, const std::vector<Anomaly>& anomalies, const Refinement& refinement);

} // namespace fettle
