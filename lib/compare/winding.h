#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle {

/// Where facets are not closed around their vertices.
struct Gaps {
    std::vector<bool> open;            ///< per vertex
    std::vector<std::uint32_t> facets; ///< with two open vertices or three, ascending
};

/// The facets to turn over so that facets that share an edge agree (where two do) and closed pieces have their outer
/// side out. Of a connected piece whose facets disagree the side with less area is turned; a closed piece that is
/// inside out is turned unless it lies within the box of another closed piece, where it may be a cavity.
/// @param vertices  3xV, mm   @param facets  3xT
std::vector<std::uint32_t> wrongly_wound(const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xi& facets,
                                         const Gaps& gaps);

} // namespace fettle
