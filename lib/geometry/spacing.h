#pragma once

#include <Eigen/Core>

namespace fettle::geometry {

/// Distance of neighbouring points of a scan, as if they lay in a square lattice: the median over the scan.
/// @param xyz  3xN, finite, at least one
double point_spacing(const Eigen::Matrix3Xd& xyz);

} // namespace fettle::geometry
