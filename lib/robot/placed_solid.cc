#include "robot/clearance.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Vector3d;

// Nearer to the axis of a frustum a direction is along it: all of an end is equally far, its centre, too.
constexpr double kAlong = 1e-12;

template <typename... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

PointDistance from_segment(const Vector3d& from, const Vector3d& to, double radius, const Vector3d& p)
{
    const Vector3d d = to - from;
    const double squared = d.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - from).dot(d) / squared, 0.0, 1.0) : 0;
    const Vector3d off = p - from - t * d;
    const double length = off.norm();
    return {length - radius, length > 0 ? Vector3d(off / length) : Vector3d::Zero()};
}

PointDistance from_box(const Eigen::Isometry3d& T_cell_box, const Vector3d& half, const Vector3d& p)
{
    const Vector3d q = T_cell_box.inverse() * p, beyond = q.cwiseAbs() - half;
    const Vector3d sign = q.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    Eigen::Index side = 0;
    const double most = beyond.maxCoeff(&side);
    if (most <= 0) return {most, T_cell_box.linear().col(side) * sign[side]};
    const Vector3d off = beyond.cwiseMax(0.0);
    return {off.norm(), T_cell_box.linear() * sign.cwiseProduct(off).normalized()};
}

} // namespace

void PlacedSolid::set_segment(const Vector3d& from, const Vector3d& to, double radius)
{
    few_.col(0) = from;
    few_.col(1) = to;
    count_ = from == to ? 1 : 2;
    radius_ = radius;
}

void PlacedSolid::set_frustum(const Vector3d& from, const Vector3d& to, double radius_from, double radius_to)
{
    kind_ = Kind::frustum;
    from_ = from;
    to_ = to;
    length_ = (to - from).norm();
    axis_ = (to - from) / length_;
    radius_from_ = radius_from;
    radius_to_ = radius_to;
}

PlacedSolid::PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T)
{
    std::visit(Overloaded{[&](const solid::Sphere& s) { set_segment(T * s.centre, T * s.centre, s.radius); },
                          [&](const solid::Capsule& s) { set_segment(T * s.from, T * s.to, s.radius); },
                          [&](const solid::Cylinder& s) { set_frustum(T * s.from, T * s.to, s.radius, s.radius); },
                          [&](const solid::Cone& s) { set_frustum(T * s.from, T * s.to, s.radius_from, s.radius_to); },
                          [&](const solid::Box& s) {
                              kind_ = Kind::box;
                              count_ = 8;
                              T_ = T * s.T_body_box;
                              half_ = s.half;
                              for (int k = 0; k < 8; ++k) {
                                  const Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
                                  few_.col(k) = T_ * Vector3d(sign.cwiseProduct(s.half));
                              }
                          },
                          [&](const solid::Hull& s) {
                              kind_ = Kind::hull;
                              hull_ = &s.points;
                              T_ = T;
                          }},
               solid);
}

PlacedSolid::PlacedSolid(const Triangle& triangle) : kind_(Kind::triangle), count_(3) { few_.leftCols<3>() = triangle; }

Vector3d PlacedSolid::farthest(const Vector3d& direction) const
{
    if (kind_ == Kind::segment || kind_ == Kind::box || kind_ == Kind::triangle) {
        int best = 0;
        double most = few_.col(0).dot(direction);
        for (int k = 1; k < count_; ++k) {
            const double along = few_.col(k).dot(direction);
            if (along > most) {
                most = along;
                best = k;
            }
        }
        return few_.col(best);
    }
    if (kind_ == Kind::hull) {
        Eigen::Index best = 0;
        (hull_->transpose() * (T_.linear().transpose() * direction)).maxCoeff(&best);
        return T_ * hull_->col(best);
    }
    Vector3d across = direction - direction.dot(axis_) * axis_;
    Vector3d rim = Vector3d::Zero();
    if (across.squaredNorm() > kAlong * kAlong * direction.squaredNorm()) {
        across -= across.dot(axis_) * axis_; // what the first difference has lost
        rim = across.normalized();
    }
    const Vector3d from = from_ + radius_from_ * rim, to = to_ + radius_to_ * rim;
    return from.dot(direction) > to.dot(direction) ? from : to;
}

PointDistance PlacedSolid::distance(const Vector3d& p) const
{
    if (kind_ == Kind::segment) return from_segment(few_.col(0), few_.col(count_ - 1), radius_, p);
    if (kind_ == Kind::box) return from_box(T_, half_, p);
    if (kind_ == Kind::frustum) {
        const double height = (p - from_).dot(axis_);
        const Vector3d across = p - from_ - height * axis_;
        const double r = across.norm();
        const ProfileDistance flat = fettle::distance({{}, radius_from_, radius_to_, length_, 0}, r, height);
        const Vector3d rim = r > 0 ? Vector3d(across / r) : axis_.unitOrthogonal();
        return {flat.value, flat.along_r * rim + flat.along_z * axis_};
    }
    const Clearance c = clearance(*this, PlacedSolid(Triangle(p.replicate<1, 3>())));
    return {c.distance, c.normal};
}

RoundSolid PlacedSolid::round() const
{
    const bool frustum = kind_ == Kind::frustum;
    const Vector3d from = frustum ? from_ : few_.col(0), way = (frustum ? to_ : few_.col(count_ - 1)) - from;
    RoundSolid solid = {Eigen::Isometry3d::Identity(), radius_from_, radius_to_, way.norm(), radius_};
    if (solid.length > 0) {
        const Vector3d axis = way / solid.length, across = axis.unitOrthogonal();
        solid.T.linear() << across, axis.cross(across), axis;
    }
    solid.T.translation() = from;
    return solid;
}

std::variant<RoundSolid, BoxSolid> PlacedSolid::outline() const
{
    if (kind_ == Kind::frustum || kind_ == Kind::segment) return round();
    if (kind_ == Kind::box) return BoxSolid{T_, half_};
    BoxSolid around{T_, {}, false};
    const Eigen::Matrix3Xd corners = kind_ == Kind::hull ? *hull_ : Eigen::Matrix3Xd(few_.leftCols(count_));
    const Vector3d least = corners.rowwise().minCoeff(), most = corners.rowwise().maxCoeff();
    around.T.translate((least + most) / 2);
    around.half = (most - least) / 2;
    return around;
}

Eigen::AlignedBox3d PlacedSolid::box() const
{
    Eigen::AlignedBox3d box;
    for (Eigen::Index k = 0; k < 3; ++k)
        for (const double sign : {-1.0, 1.0}) {
            const Vector3d direction = sign * Vector3d::Unit(k);
            const double most = farthest(direction).dot(direction) + radius_;
            (sign < 0 ? box.min() : box.max())[k] = sign * most;
        }
    return box;
}

} // namespace fettle
