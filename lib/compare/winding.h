#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::compare {

/// Open vertices of a mesh: those at an edge that its facets do not run along equally often in both directions, either
/// because it is a border or because their windings disagree.
struct OpenVertices {
    std::vector<bool> open;            ///< per vertex
    std::vector<std::uint32_t> facets; ///< with two or three open vertices, ascending
};

/// Facets to flip so that neighbours across an edge agree (where two meet) and closed components face outward. In a
/// connected component whose facets disagree the side with less area is flipped. A closed component that is inside out
/// is flipped unless it lies within the box of another one, where it may be a cavity.
/// @param vertices  3xV, mm   @param facets  3xT
std::vector<std::uint32_t> facets_to_flip(const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xi& facets,
                                          const OpenVertices& open_vertices);

} // namespace fettle::compare
