#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <variant>

/// Convex solids, mm, in the frame of the body they belong to.
namespace fettle::solid {

struct Sphere {
    Eigen::Vector3d centre;
    double radius;
};

/// All points within `radius` of a segment.
struct Capsule {
    Eigen::Vector3d from, to;
    double radius;
};

/// With flat ends at `from` and `to`.
struct Cylinder {
    Eigen::Vector3d from, to;
    double radius;
};

/// A frustum; one of the radii may be 0.
struct Cone {
    Eigen::Vector3d from, to;
    double radius_from, radius_to;
};

struct Box {
    Eigen::Isometry3d T_body_box; ///< the box's frame stands at its centre, along its sides
    Eigen::Vector3d half;         ///< of the sides
};

/// The convex hull of points.
struct Hull {
    Eigen::Matrix3Xd points;
};

} // namespace fettle::solid

namespace fettle {

using Solid = std::variant<solid::Sphere, solid::Capsule, solid::Cylinder, solid::Cone, solid::Box, solid::Hull>;

} // namespace fettle
