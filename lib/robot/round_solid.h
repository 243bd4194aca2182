#pragma once

#include "mesh/triangle.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace fettle {

/// A solid of revolution about z in its own frame: all points within `rounding` of a frustum from z = 0 to `length`,
/// mm. Of a capsule the frustum is a segment.
struct RoundSolid {
    Eigen::Isometry3d T; ///< of its frame
    double radius_from = 0, radius_to = 0, length = 0, rounding = 0;
};

/// Signed distance in the plane of the axis and the point, mm. It is convex and never shrinks with r.
struct ProfileDistance {
    double value = 0;
    double along_r = 0, along_z = 0; ///< its gradient: unit
};

/// Of the point at radius r and height z. The solid must have a length.
ProfileDistance distance(const RoundSolid& solid, double r, double z);

/// The point of a triangle that is nearest to a solid or deepest in it.
struct TriangleFoot {
    double distance = 0; ///< from the solid's surface, mm; negative inside
    Eigen::Vector3d gradient;
    Eigen::Vector3d point;
};

/// What is found is nearer than any other point but for this, mm, a hundredth of kClearanceTolerance.
inline constexpr double kFootTolerance = 1e-7;

/// The least signed distance of a triangle's points, certain to kFootTolerance. Of each height of the triangle the
/// point nearest to the axis is the best one, in closed form; along the height what remains is convex, and its tangents
/// bound it from below.
/// @return  nothing if no point is nearer than `below` by more than kFootTolerance
std::optional<TriangleFoot> nearest_of_triangle(const RoundSolid& solid, const Triangle& triangle, double below);

} // namespace fettle
