#include "robot/dh_from_axes.h"

#include "core/error.h"

#include <cmath>
#include <numbers>
#include <string>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Axes whose angle has a smaller sine are parallel, and twists that differ less from a right angle are one: URDFs round
// angles to three digits after the point and more. Newton's method corrects what remains (Arm::corrected).
constexpr double kParallelSine = 2e-3;
// Parallel to rounding. Axes that are so nearly only have their true common normal, which may be far away.
constexpr double kExactlyParallelSine = 1e-12;
// Axes nearer to each other intersect, mm: URDFs round lengths to 0.1 mm.
constexpr double kIntersectionDistance = 0.2;
// Normals of nearly parallel axes that are farther away than any arm reaches say nothing about its shape, mm.
constexpr double kFarNormal = 1e4;
// Parallel axes nearer to each other coincide, mm.
constexpr double kMinAxisDistance = 1e-6;

Isometry3d frame_of(const Vector3d& x, const Vector3d& z, const Vector3d& origin)
{
    Isometry3d T = Isometry3d::Identity();
    T.linear() << x, z.cross(x), z;
    T.translation() = origin;
    return T;
}

/// The common normal of two lines: its foot on the second, and its direction towards it.
struct Normal {
    Vector3d foot_before, foot, x;
};

// @param before  frame on the first line
Normal common_normal(const Isometry3d& before, const JointAxis& line, std::size_t joint)
{
    const Vector3d z0 = before.linear().col(2), z1 = line.direction, from = line.point - before.translation();
    const Vector3d cross = z0.cross(z1);
    const double sine = cross.norm();
    if (sine < kExactlyParallelSine) {
        const Vector3d foot = line.point - from.dot(z1) * z1, across = foot - before.translation();
        const double distance = across.norm();
        if (distance < kMinAxisDistance)
            throw core::InputError("the axes of joints " + std::to_string(joint) + " and " + std::to_string(joint + 1) +
                                   " coincide");
        return {before.translation(), foot, across / distance};
    }
    // Points of the lines nearest to each other.
    const double t0 = from.cross(z1).dot(cross) / (sine * sine), t1 = from.cross(z0).dot(cross) / (sine * sine);
    const Vector3d foot_before = before.translation() + t0 * z0, foot = line.point + t1 * z1;
    const Vector3d across = foot - foot_before;
    const double a = across.dot(cross / sine);
    return {foot_before, foot, cross / sine * (a < 0 ? -1 : 1)};
}

bool is_right(double alpha) { return std::abs(std::cos(alpha)) < kParallelSine; }
bool is_zero(double length) { return std::abs(length) < kIntersectionDistance; }

ArmKind kind_of(const std::array<DhRow, 6>& dh)
{
    const auto is_parallel = [&](std::size_t i) {
        return std::abs(std::sin(dh[i].alpha)) < kParallelSine && std::abs(dh[i].d) < kFarNormal;
    };
    const bool has_upper_arm = is_right(dh[0].alpha) && is_parallel(1) && !is_zero(dh[1].a);
    if (!has_upper_arm || !is_right(dh[3].alpha) || !is_right(dh[4].alpha)) return ArmKind::general;
    if (is_right(dh[2].alpha) && is_zero(dh[3].a) && is_zero(dh[4].a) && is_zero(dh[4].d) &&
        std::hypot(dh[2].a, dh[3].d) > kIntersectionDistance)
        return ArmKind::spherical_wrist;
    if (is_parallel(2) && is_zero(dh[0].a) && !is_zero(dh[2].a) && is_zero(dh[3].a) && is_zero(dh[4].a))
        return ArmKind::parallel_axes;
    return ArmKind::general;
}

} // namespace

DhFromAxes dh_from_axes(const std::array<JointAxis, 6>& axes)
{
    DhFromAxes result;
    std::array<JointAxis, 6> lines = axes;
    for (std::size_t i = 2; i < 4; ++i) { // one direction for parallel axes
        const Vector3d &z0 = lines[i - 1].direction, &z1 = axes[i].direction;
        if (z0.cross(z1).norm() < kParallelSine && z0.dot(z1) < 0) {
            lines[i].direction = -z1;
            result.dh[i].sign = -1;
        }
    }
    const Vector3d z0 = lines[0].direction;
    Vector3d x0 = Vector3d::UnitX() - z0.x() * z0;
    if (x0.norm() < 0.5) x0 = Vector3d::UnitY() - z0.y() * z0;
    // The origin of frame 0 is on axis 1 at the height of the base.
    Isometry3d frame = frame_of(x0.normalized(), z0, lines[0].point - lines[0].point.dot(z0) * z0);
    result.T_base_0 = frame;
    for (std::size_t i = 0; i + 1 < 6; ++i) {
        const Normal normal = common_normal(frame, lines[i + 1], i + 1);
        const Vector3d z = frame.linear().col(2), x = frame.linear().col(0), y = frame.linear().col(1);
        const Isometry3d next = frame_of(normal.x, lines[i + 1].direction, normal.foot);
        DhRow& row = result.dh[i];
        row.offset = std::atan2(normal.x.dot(y), normal.x.dot(x));
        row.d = (normal.foot_before - frame.translation()).dot(z);
        row.a = (normal.foot - normal.foot_before).dot(normal.x);
        row.alpha = std::atan2(z.cross(next.linear().col(2)).dot(normal.x), z.dot(next.linear().col(2)));
        frame = next;
    }
    result.kind = kind_of(result.dh);
    return result;
}

} // namespace fettle::robot
