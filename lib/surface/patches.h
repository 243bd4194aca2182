#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// A closed (rational) B-spline curve in the plane of u and v.
struct TrimCurve {
    int degree = 1;
    Eigen::VectorXd knots;    ///< ascending; control points + degree + 1 of them
    Eigen::Matrix2Xd control; ///< u, v
    Eigen::VectorXd weights;  ///< of the control points; empty: all 1
};

/// A (rational) tensor-product B-spline patch, x y z over (u, v).
struct Patch {
    int degree_u = 3, degree_v = 3;
    Eigen::VectorXd knots_u, knots_v;       ///< ascending; control points + degree + 1 of them
    std::array<Eigen::MatrixXd, 3> control; ///< x, y, z of the control points, mm; rows along u, columns along v
    Eigen::MatrixXd weights;                ///< of the control points; empty: all 1
    std::vector<TrimCurve> trim;            ///< the patch is where an odd number of them goes around; none: everywhere
};

/// Reads a file of kind "patches". @param path  "-": stdin   @throws InputError with the key's path
std::vector<Patch> read_patches(const std::string& path);
/// The same from text. @param source  the name for messages
std::vector<Patch> parse_patches(std::string_view text, const std::string& source);

/// Where the knots let u (row 0) and v (row 1) be: least, most.
Eigen::Matrix2d domain(const Patch& patch);

/// The trimming curves as closed polygons (the last point is the first), or without them the domain's. Where a span is
/// a quarter of a circle, the polygon is off by a 13,000th of the radius.
std::vector<Eigen::Matrix2Xd> outlines(const Patch& patch);

/// Does an odd number of the polygons go around uv?
bool inside(const std::vector<Eigen::Matrix2Xd>& outlines, const Eigen::Vector2d& uv);

/// Point of the patch and its derivatives in u and v, one a column. @param uv  within the knots' domain
Eigen::Matrix3d point_and_tangents(const Patch& patch, const Eigen::Vector2d& uv);

/// z over xy, mm, exact to rounding: (u, v) by Newton's method, in one step if x and y are linear in them. NaN outside
/// the patch and what its trimming curves leave of it.
double height(const Patch& patch, const Eigen::Vector2d& xy);

} // namespace fettle
