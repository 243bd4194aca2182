#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace fettle {

/// A (rational) tensor-product B-spline patch, x y z over (u, v).
struct Patch {
    int degree_u = 3, degree_v = 3;
    Eigen::VectorXd knots_u, knots_v;       ///< ascending; control points + degree + 1 of them
    std::array<Eigen::MatrixXd, 3> control; ///< x, y, z of the control points, mm; rows along u, columns along v
    Eigen::MatrixXd weights;                ///< of the control points; empty: all 1
};

/// Reads a file of kind "patches". @throws InputError with the key's path
std::vector<Patch> read_patches(const std::string& path);

/// Point of the patch and its derivatives in u and v, one a column. @param uv  within the knots' domain
Eigen::Matrix3d point_and_tangents(const Patch& patch, const Eigen::Vector2d& uv);

/// z over xy, mm, exact to rounding: (u, v) by Newton's method, in one step if x and y are linear in them. NaN outside
/// the patch.
double height(const Patch& patch, const Eigen::Vector2d& xy);

} // namespace fettle
