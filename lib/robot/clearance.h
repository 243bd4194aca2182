#pragma once

#include "mesh/triangle.h"
#include "robot/round_solid.h"
#include "robot/solid.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <limits>
#include <variant>

namespace fettle::robot {

/// Signed distance of a point from a convex solid. It is convex in the point: distance(q) >= value + gradient · (q -
/// p).
struct PointDistance {
    double value = 0;                                   ///< mm, negative inside
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero(); ///< unit; 0 at the core of a sphere or capsule
};

/// A box about the origin of its frame.
struct BoxSolid {
    Eigen::Isometry3d T;  ///< T_cell_box
    Eigen::Vector3d half; ///< half the sides, mm
    bool exact = true;    ///< false: the solid is another one, and this is a box around it
};

/// A convex solid at a place in the cell: all points within `radius` of a core (a point, segment, box, triangle, hull
/// or frustum). Distances and overlaps are measured between the cores.
class PlacedSolid {
  public:
    /// The solid must outlive it. Of triangles it is the convex hull.
    PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T_cell_body);
    explicit PlacedSolid(const mesh::Triangle& triangle) : core_(triangle) {}

    /// Support mapping: a point of the core that is farthest along a direction, which need not be unit.
    Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
    double radius() const { return radius_; }
    /// Signed distance of a point from the solid, not from its core.
    PointDistance signed_distance(const Eigen::Vector3d& point) const;
    /// Axis-aligned bounding box of the solid.
    Eigen::AlignedBox3d bounding_box() const;
    /// The solid as a shape whose distance has a closed form; for a hull or triangle a box around it.
    std::variant<RoundSolid, BoxSolid> primitive_shape() const;
    bool is_sphere() const;

  private:
    /// The core of a sphere (`from` equals `to`) or capsule.
    struct Segment {
        Eigen::Vector3d from, to;
    };
    struct Box {
        Eigen::Isometry3d T; ///< T_cell_box
        Eigen::Vector3d half;
        Eigen::Matrix<double, 3, 8> corners; ///< cell frame
    };
    struct Hull {
        const Eigen::Matrix3Xd* points; ///< body frame
        Eigen::Isometry3d T;            ///< T_cell_body
    };
    struct Frustum {
        Eigen::Vector3d from, to;
        double radius_from, radius_to, length;
        Eigen::Vector3d axis; ///< unit, from `from` to `to`
    };

    std::variant<Segment, Box, mesh::Triangle, Hull, Frustum> core_;
    double radius_ = 0;
};

/// Signed distance of two solids, mm. Where they overlap it is negative, the length of the shortest translation that
/// separates them.
struct Clearance {
    double distance = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(); ///< unit, from a to b: the direction in which b leaves a
    Eigen::Vector3d on_a = Eigen::Vector3d::Zero();    ///< the point of a nearest to b, or deepest in it
    Eigen::Vector3d on_b = Eigen::Vector3d::Zero();    ///< on_a + distance * normal
};

/// Turns the clearance of the surfaces of a solid a inside b, or b inside a, into that of the solids: the negative
/// distance that one moves until it is beyond the plane at the nearest point of the other.
/// @param width  of the inner solid along the normal, mm
void make_penetration(Clearance& clearance, double width);

/// Error bound of distances and depths, mm, a thousandth of what machining asks for. All but one in some thousand are
/// accurate to 1e-8: where rims of round solids nearly touch, rounding ends the search earlier.
inline constexpr double kClearanceAccuracy = 1e-5;

/// Distance by Gilbert, Johnson & Keerthi (1988), depth by van den Bergen's expanding polytope (2001). Both iterate
/// until an upper and a lower bound agree. (FCL, the reference of the tests, does not give the depth.)
/// @param max_distance  beyond it the search may stop: the distance is then a lower bound above `max_distance`
Clearance clearance(const PlacedSolid& a, const PlacedSolid& b,
                    double max_distance = std::numeric_limits<double>::infinity());

} // namespace fettle::robot
