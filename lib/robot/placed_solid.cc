#include "geometry/bounding_box.h"
#include "robot/clearance.h"
#include "robot/mesh_body.h"

#include <algorithm>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Below this sine a direction counts as along the axis of a frustum: all of an end is then equally far, also its
// centre.
constexpr double kMinSineToAxis = 1e-12;

template <typename... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

template <typename Corners>
Vector3d farthest_corner(const Corners& corners, const Vector3d& direction)
{
    Eigen::Index best = 0;
    double max = corners.col(0).dot(direction);
    for (Eigen::Index k = 1; k < corners.cols(); ++k) {
        const double along = corners.col(k).dot(direction);
        if (along > max) {
            max = along;
            best = k;
        }
    }
    return corners.col(best);
}

PointDistance distance_from_segment(const Vector3d& from, const Vector3d& to, double radius, const Vector3d& p)
{
    const Vector3d d = to - from;
    const double squared = d.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - from).dot(d) / squared, 0.0, 1.0) : 0;
    const Vector3d off = p - from - t * d;
    const double length = off.norm();
    return {length - radius, length > 0 ? Vector3d(off / length) : Vector3d::Zero()};
}

PointDistance distance_from_box(const Eigen::Isometry3d& T_cell_box, const Vector3d& half, const Vector3d& p)
{
    const Vector3d q = T_cell_box.inverse() * p, excess = q.cwiseAbs() - half;
    const Vector3d sign = q.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    Eigen::Index side = 0;
    const double max = excess.maxCoeff(&side);
    if (max <= 0) return {max, T_cell_box.linear().col(side) * sign[side]};
    const Vector3d off = excess.cwiseMax(0.0);
    return {off.norm(), T_cell_box.linear() * sign.cwiseProduct(off).normalized()};
}

// A round solid about the segment between two points.
RoundSolid round_solid(const Vector3d& from, const Vector3d& to, double radius_from, double radius_to, double rounding)
{
    const Vector3d between = to - from;
    RoundSolid solid = {Eigen::Isometry3d::Identity(), radius_from, radius_to, between.norm(), rounding};
    if (solid.length > 0) {
        const Vector3d axis = between / solid.length, across = axis.unitOrthogonal();
        solid.T.linear() << across, axis.cross(across), axis;
    }
    solid.T.translation() = from;
    return solid;
}

// The bounding box of corners, along the axes of their frame.
template <typename Corners>
BoxSolid box_around(const Eigen::Isometry3d& T, const Corners& corners)
{
    const Eigen::AlignedBox3d bounds = geometry::bounding_box(corners);
    BoxSolid box{T, bounds.sizes() / 2, false};
    box.T.translate(bounds.center());
    return box;
}

} // namespace

PlacedSolid::PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T)
{
    const auto set_segment = [&](const Vector3d& from, const Vector3d& to, double radius) {
        core_ = Segment{from, to};
        radius_ = radius;
    };
    const auto set_frustum = [&](const Vector3d& from, const Vector3d& to, double radius_from, double radius_to) {
        const double length = (to - from).norm();
        core_ = Frustum{from, to, radius_from, radius_to, length, (to - from) / length};
    };
    std::visit(Overloaded{[&](const solid::Sphere& s) { set_segment(T * s.centre, T * s.centre, s.radius); },
                          [&](const solid::Capsule& s) { set_segment(T * s.from, T * s.to, s.radius); },
                          [&](const solid::Cylinder& s) { set_frustum(T * s.from, T * s.to, s.radius, s.radius); },
                          [&](const solid::Cone& s) { set_frustum(T * s.from, T * s.to, s.radius_from, s.radius_to); },
                          [&](const solid::Box& s) {
                              Box box{T * s.T_body_box, s.half, {}};
                              for (int k = 0; k < 8; ++k) {
                                  const Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
                                  box.corners.col(k) = box.T * Vector3d(sign.cwiseProduct(s.half));
                              }
                              core_ = box;
                          },
                          [&](const solid::Hull& s) {
                              core_ = Hull{&s.points, T};
                          },
                          [&](const solid::Triangles& s) {
                              core_ = Hull{&s.body->hull, T};
                          }},
               solid);
}

bool PlacedSolid::is_sphere() const
{
    const auto* segment = std::get_if<Segment>(&core_);
    return segment != nullptr && segment->from == segment->to;
}

Vector3d PlacedSolid::support(const Vector3d& direction) const
{
    return std::visit(
        Overloaded{
            [&](const Segment& s) -> Vector3d { return s.to.dot(direction) > s.from.dot(direction) ? s.to : s.from; },
            [&](const Box& box) { return farthest_corner(box.corners, direction); },
            [&](const mesh::Triangle& triangle) { return farthest_corner(triangle, direction); },
            [&](const Hull& hull) -> Vector3d {
                return hull.T * farthest_corner(*hull.points, hull.T.linear().transpose() * direction);
            },
            [&](const Frustum& f) -> Vector3d {
                Vector3d across = direction - direction.dot(f.axis) * f.axis;
                Vector3d rim = Vector3d::Zero();
                if (across.squaredNorm() > kMinSineToAxis * kMinSineToAxis * direction.squaredNorm()) {
                    across -= across.dot(f.axis) * f.axis; // once more, against cancellation
                    rim = across.normalized();
                }
                const Vector3d from = f.from + f.radius_from * rim, to = f.to + f.radius_to * rim;
                return from.dot(direction) > to.dot(direction) ? from : to;
            }},
        core_);
}

PointDistance PlacedSolid::signed_distance(const Vector3d& p) const
{
    if (const auto* s = std::get_if<Segment>(&core_)) return distance_from_segment(s->from, s->to, radius_, p);
    if (const auto* box = std::get_if<Box>(&core_)) return distance_from_box(box->T, box->half, p);
    if (const auto* f = std::get_if<Frustum>(&core_)) {
        const double height = (p - f->from).dot(f->axis);
        const Vector3d across = p - f->from - height * f->axis;
        const double r = across.norm();
        const ProfileDistance profile = profile_distance({{}, f->radius_from, f->radius_to, f->length, 0}, r, height);
        const Vector3d rim = r > 0 ? Vector3d(across / r) : f->axis.unitOrthogonal();
        return {profile.value, profile.gradient_r * rim + profile.gradient_z * f->axis};
    }
    const Clearance c = clearance(*this, PlacedSolid(mesh::Triangle(p.replicate<1, 3>())));
    return {c.distance, c.normal};
}

std::variant<RoundSolid, BoxSolid> PlacedSolid::primitive_shape() const
{
    using Shape = std::variant<RoundSolid, BoxSolid>;
    return std::visit(
        Overloaded{
            [&](const Segment& s) -> Shape { return round_solid(s.from, s.to, 0, 0, radius_); },
            [&](const Box& box) -> Shape {
                return BoxSolid{box.T, box.half};
            },
            [&](const mesh::Triangle& t) -> Shape { return box_around(Eigen::Isometry3d::Identity(), t); },
            [&](const Hull& hull) -> Shape { return box_around(hull.T, *hull.points); },
            [&](const Frustum& f) -> Shape { return round_solid(f.from, f.to, f.radius_from, f.radius_to, radius_); }},
        core_);
}

Eigen::AlignedBox3d PlacedSolid::bounding_box() const
{
    Eigen::AlignedBox3d box;
    for (Eigen::Index k = 0; k < 3; ++k)
        for (const double sign : {-1.0, 1.0}) {
            const Vector3d direction = sign * Vector3d::Unit(k);
            const double extent = support(direction).dot(direction) + radius_;
            (sign < 0 ? box.min() : box.max())[k] = sign * extent;
        }
    return box;
}

} // namespace fettle::robot
