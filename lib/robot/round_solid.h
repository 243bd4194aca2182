#pragma once

#include "mesh/triangle.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace fettle::robot {

/// A solid of revolution about z in its own frame: all points within `rounding` of a frustum from z = 0 to `length`,
/// mm. The frustum of a capsule is a segment, that of a sphere a point.
struct RoundSolid {
    Eigen::Isometry3d T; ///< T_cell_solid
    double radius_from = 0, radius_to = 0, length = 0, rounding = 0;
};

/// Signed distance in the half-plane through the axis and the point. It is convex and does not decrease with r.
struct ProfileDistance {
    double value = 0;                      ///< mm, negative inside
    double gradient_r = 0, gradient_z = 0; ///< unit
};

/// Signed distance of the point at radius r and height z, mm, in the solid's frame. The solid must have a length.
ProfileDistance profile_distance(const RoundSolid& solid, double r, double z);

/// The point of a triangle that is nearest to a solid or deepest in it.
struct TriangleFoot {
    double distance = 0;      ///< from the solid's surface, mm; negative inside
    Eigen::Vector3d gradient; ///< of the signed distance, unit
    Eigen::Vector3d point;
};

/// Error bound of the distance of a TriangleFoot, mm, a hundredth of kClearanceAccuracy.
inline constexpr double kFootAccuracy = 1e-7;

/// The minimum signed distance of a triangle's points, to kFootAccuracy. At each height the point nearest to the axis
/// is the best one, in closed form; the distance of these points is convex along the height, and its tangents bound it
/// from below. Of a capsule all is in closed form.
/// @return  nothing if no point is nearer than `upper_bound`, mm, by more than kFootAccuracy
std::optional<TriangleFoot> nearest_point_of_triangle(const RoundSolid& solid, const mesh::Triangle& triangle,
                                                      double upper_bound);

} // namespace fettle::robot
