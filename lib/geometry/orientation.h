#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::geometry {

/// Turns normals to one side of the surface: neighbours agree, the pairs with the most parallel normals first (Hoppe et
/// al., Surface reconstruction from unorganized points, 1992). The pieces of the surface turn to where `hints` point,
/// and without hints to the side of the largest piece: one scanner has seen them all.
/// @param normals     3xN, unit or zero   @param xyz  3xN, mm
/// @param neighbours  of each point
/// @param hints       3xN: towards the outer side; zero: unknown
void orient_consistently(Eigen::Matrix3Xd& normals, const Eigen::Matrix3Xd& xyz,
                         const std::vector<std::vector<std::uint32_t>>& neighbours, const Eigen::Matrix3Xd& hints);

} // namespace fettle::geometry
