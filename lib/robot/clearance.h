#pragma once

#include "mesh/triangle.h"
#include "robot/round_solid.h"
#include "robot/solid.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <limits>
#include <variant>

namespace fettle {

/// Of a point from a solid, mm: negative inside. It is convex in the point: gradient · (q - p) is no more than what it
/// grows by on the way to any q.
struct PointDistance {
    double value = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero(); ///< unit; 0 at the core of a sphere or capsule
};

/// A box about the origin of its frame, mm.
struct BoxSolid {
    Eigen::Isometry3d T;
    Eigen::Vector3d half; ///< of the sides
    bool exact = true;    ///< or else it is only around a solid
};

/// A convex solid where it stands: all points within `radius` of a core.
class PlacedSolid {
  public:
    /// The solid must outlive it.
    PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T_cell_body);
    explicit PlacedSolid(const Triangle& triangle);

    /// A point of the core that is farthest along a direction, which need not be unit.
    Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const;
    double radius() const { return radius_; }
    /// Of the solid, not of its core.
    PointDistance distance(const Eigen::Vector3d& point) const;
    /// Of the solid, not of its core.
    Eigen::AlignedBox3d box() const;
    /// The solid itself; around a hull or a triangle a box.
    std::variant<RoundSolid, BoxSolid> outline() const;
    bool is_sphere() const { return kind_ == Kind::segment && count_ == 1; }

  private:
    enum class Kind { segment, box, triangle, hull, frustum };
    void set_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);
    void set_frustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from, double radius_to);
    RoundSolid round() const;

    Kind kind_ = Kind::segment;
    int count_ = 0;
    Eigen::Matrix<double, 3, 8> few_;                     ///< corners of a polytope
    const Eigen::Matrix3Xd* hull_ = nullptr;              ///< its corners, in the body's frame
    Eigen::Isometry3d T_ = Eigen::Isometry3d::Identity(); ///< of a hull's or a box's frame
    Eigen::Vector3d half_;                                ///< of a box's sides
    Eigen::Vector3d from_, to_, axis_;                    ///< of a frustum
    double length_ = 0, radius_from_ = 0, radius_to_ = 0;
    double radius_ = 0; ///< about the core
};

/// How far two bodies are apart, mm. Where they overlap it is negative, the length of the shortest shift that parts
/// them.
struct Clearance {
    double distance = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(); ///< unit, from a to b: b must go that way to leave a
    Eigen::Vector3d on_a = Eigen::Vector3d::Zero();    ///< the point of a nearest to b, or deepest in it
    Eigen::Vector3d on_b = Eigen::Vector3d::Zero();    ///< on_a + distance * normal
};

/// Distances and depths are certain to within this, mm, a thousandth of what machining asks for. All but one in some
/// thousand are so to 1e-8: where rims of round solids nearly touch, roundings end the search earlier.
inline constexpr double kClearanceTolerance = 1e-5;

/// Distance by Gilbert, Johnson & Keerthi (1988), depth by van den Bergen's expanding polytope (2001): both end when an
/// upper and a lower bound agree.
/// @param beyond  if they are farther apart than that it may stop: the distance is then a lower bound above `beyond`
Clearance clearance(const PlacedSolid& a, const PlacedSolid& b,
                    double beyond = std::numeric_limits<double>::infinity());

} // namespace fettle
