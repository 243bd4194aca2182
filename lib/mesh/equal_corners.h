#pragma once

#include "mesh/mesh.h"

#include <array>
#include <cstddef>
#include <functional>

namespace fettle::mesh {

/// Coordinates of a facet's corner.
template <typename T>
using Corner = std::array<T, 3>;

/// Copies the corners of `count` facets from facet `first` on, three per facet, to `to`. Called by several threads at
/// once.
template <typename T>
using CornerSource = std::function<void(std::size_t first, std::size_t count, Corner<T>* to)>;

/// Merges exactly equal corners of facets into vertices, numbered in order of appearance. Facets with NaN or infinite
/// corners are dropped. @param facets  less than 2^30 / 3   @param repair  counts both
template <typename T>
Mesh weld_facets(std::size_t facets, const CornerSource<T>& corners, MeshRepair& repair);

extern template Mesh weld_facets(std::size_t facets, const CornerSource<float>& corners, MeshRepair& repair);
extern template Mesh weld_facets(std::size_t facets, const CornerSource<double>& corners, MeshRepair& repair);

} // namespace fettle::mesh
