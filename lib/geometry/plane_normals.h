#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace fettle::geometry {

/// Normals of planes through the points around each point, on either side of the surface.
struct PlaneNormals {
    Eigen::Matrix3Xd normals;                      ///< unit; zero where there are fewer than three points
    std::vector<std::vector<std::uint32_t>> links; ///< from point to point next to it, for orient_consistently()
};

/// Planes of least squares through the 16 nearest points: they average noise and stay on one face.
/// @param xyz  3xN, mm, finite
PlaneNormals plane_normals(const Eigen::Matrix3Xd& xyz);

} // namespace fettle::geometry
