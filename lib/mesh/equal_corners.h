#pragma once

#include "mesh/mesh.h"

#include <array>
#include <cstddef>
#include <functional>

namespace fettle {

/// The three coordinates of a facet's corner.
template <typename T>
using Corner = std::array<T, 3>;

/// Copies the corners of `count` facets from the first-th on, three a facet, to where there is room for them. Called by
/// several threads at once.
template <typename T>
using CornerSource = std::function<void(std::size_t first, std::size_t count, Corner<T>* to)>;

/// Facets with equal corners made one vertex; the vertices are numbered as they first appear. Facets with NaN or
/// infinite corners are left out. @param facets  fewer than 2^30 / 3
template <typename T>
Mesh welded(std::size_t facets, const CornerSource<T>& corners, MeshRepair& repair);

extern template Mesh welded(std::size_t facets, const CornerSource<float>& corners, MeshRepair& repair);
extern template Mesh welded(std::size_t facets, const CornerSource<double>& corners, MeshRepair& repair);

} // namespace fettle
