#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <variant>

namespace fettle::robot {
struct MeshBody;
}

/// Solids in the frame of the body that they belong to, mm. All but triangles are convex.
namespace fettle::robot::solid {

struct Sphere {
    Eigen::Vector3d centre;
    double radius;
};

/// All points within `radius` of a segment.
struct Capsule {
    Eigen::Vector3d from, to;
    double radius;
};

/// A cylinder with flat ends at `from` and `to`.
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
    Eigen::Isometry3d T_body_box; ///< origin at the centre of the box, axes along its sides
    Eigen::Vector3d half;         ///< half the sides
};

/// The convex hull of points.
struct Hull {
    Eigen::Matrix3Xd points;
};

/// A mesh, convex or not, every triangle of which counts. Where only a convex solid will do its hull stands for it.
struct Triangles {
    std::shared_ptr<const MeshBody> body;
};

} // namespace fettle::robot::solid

namespace fettle::robot {

using Solid = std::variant<solid::Sphere, solid::Capsule, solid::Cylinder, solid::Cone, solid::Box, solid::Hull,
                           solid::Triangles>;

} // namespace fettle::robot
