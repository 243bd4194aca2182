#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Refuses points that lie farther out than any part or scan does: with them, squares and counts of cells would
/// overflow. Points that are NaN or infinite pass: they are missing, not far.
/// @param xyz     3xN, mm
/// @param source  the name for messages
/// @throws InputError with the point's number
void check_reach(const Eigen::Matrix3Xd& xyz, const std::string& source);

} // namespace fettle
