#include "robot/clearance.h"

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
    axis_ = (to - from).normalized();
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
                              count_ = 8;
                              for (int k = 0; k < 8; ++k) {
                                  const Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
                                  few_.col(k) = T * (s.T_body_box * Vector3d(sign.cwiseProduct(s.half)));
                              }
                          },
                          [&](const solid::Hull& s) {
                              kind_ = Kind::hull;
                              hull_ = &s.points;
                              T_ = T;
                          }},
               solid);
}

PlacedSolid::PlacedSolid(const Triangle& triangle) : count_(3) { few_.leftCols<3>() = triangle; }

Vector3d PlacedSolid::farthest(const Vector3d& direction) const
{
    if (kind_ == Kind::few_points) {
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
