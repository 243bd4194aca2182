#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::surface {

/// Closed, possibly rational B-spline curve in the parameter plane (u, v).
struct TrimCurve {
    int degree = 1;
    Eigen::VectorXd knots;    ///< ascending; control points + degree + 1 of them
    Eigen::Matrix2Xd control; ///< u, v
    Eigen::VectorXd weights;  ///< weights of the control points; empty: all 1
};

/// Tensor-product B-spline patch, possibly rational: x, y, z over (u, v).
struct Patch {
    int degree_u = 3, degree_v = 3;
    Eigen::VectorXd knots_u, knots_v;       ///< ascending; control points + degree + 1 of them
    std::array<Eigen::MatrixXd, 3> control; ///< x, y, z of the control points, mm; rows along u, columns along v
    Eigen::MatrixXd weights;                ///< weights of the control points; empty: all 1
    std::vector<TrimCurve> trim;            ///< the patch is the area inside an odd number of them; none: all
};

/// Reads a file of kind "patches". @param path  "-": stdin   @throws InputError with the key's path
std::vector<Patch> read_patches(const std::string& path);
/// Parses the text of such a file. @param source  the name for messages
std::vector<Patch> parse_patches(std::string_view text, const std::string& source);

/// The domain that the knots give to u (row 0) and v (row 1): minimum and maximum.
Eigen::Matrix2d parameter_domain(const Patch& patch);

/// The trimming curves as closed polygons (the last point is the first); without trimming curves, the domain. For spans
/// of a quarter of a circle, the polygon deviates from the curve by 1/13,000 of the radius.
std::vector<Eigen::Matrix2Xd> boundary_polygons(const Patch& patch);

/// Is uv inside an odd number of the polygons?
bool is_inside(const std::vector<Eigen::Matrix2Xd>& outlines, const Eigen::Vector2d& uv);

/// Columns: point of the patch, its derivative in u, its derivative in v, mm. @param uv  within the domain
Eigen::Matrix3d point_and_tangents(const Patch& patch, const Eigen::Vector2d& uv);

/// z over xy, mm, exact to rounding; NaN outside the trimmed patch. (u, v) follow by Newton's method, in one step if x
/// and y are linear in them.
double height(const Patch& patch, const Eigen::Vector2d& xy);

} // namespace fettle::surface
