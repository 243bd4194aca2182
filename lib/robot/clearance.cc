#include "robot/clearance.h"

#include "robot/depth.h"
#include "robot/simplex.h"

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Two curved rims need some fifty steps, polytopes a dozen.
constexpr int kMaxClearanceSteps = 200;
// The search ends when the upper and lower bound of a distance differ by no more, mm. Cores as near as that touch.
constexpr double kDistanceTolerance = 1e-9;
// Points of the Minkowski difference count as equal within this fraction of their size.
constexpr double kDuplicatePointTolerance = 1e-14;

bool contains(const Simplex& simplex, const Vector3d& w)
{
    const double tolerance = kDuplicatePointTolerance * w.squaredNorm();
    for (int i = 0; i < simplex.count; ++i)
        if ((simplex.point[i].w - w).squaredNorm() <= tolerance * kDuplicatePointTolerance) return true;
    return false;
}

// From the clearance of the cores to that of the solids.
Clearance with_radii(Clearance cores, const PlacedSolid& a, const PlacedSolid& b)
{
    cores.distance -= a.radius() + b.radius();
    cores.on_a += a.radius() * cores.normal;
    cores.on_b -= b.radius() * cores.normal;
    return cores;
}

} // namespace

Clearance clearance(const PlacedSolid& a, const PlacedSolid& b, double max_distance)
{
    const double radii = a.radius() + b.radius();
    Simplex simplex;
    simplex.add(difference_support(a, b, Vector3d::UnitX()));
    reduce(simplex);
    Vector3d v = simplex.nearest();
    for (int step = 0; step < kMaxClearanceSteps; ++step) {
        const double length = v.norm();
        if (length <= kDistanceTolerance) return with_radii(core_depth(a, b, simplex), a, b);
        const DifferencePoint next = difference_support(a, b, -v);
        const double lower = v.dot(next.w) / length; // the supporting plane separates the cores by as much
        if (length - lower <= kDistanceTolerance || contains(simplex, next.w)) break;
        if (lower - radii > max_distance) return {lower - radii, v / length, simplex.on_a(), simplex.on_b()};
        Simplex larger = simplex;
        larger.add(next);
        if (reduce(larger)) {
            if (!(lower > 0)) return with_radii(core_depth(a, b, larger), a, b);
            larger = simplex; // a plane separates the cores: the tetrahedron is flat to rounding
            larger.add(next);
            reduce(larger, true);
        }
        const Vector3d nearer = larger.nearest();
        if (!(nearer.squaredNorm() < v.squaredNorm())) break; // no progress beyond rounding
        simplex = larger;
        v = nearer;
    }
    const double length = v.norm();
    return with_radii({length, v / length, simplex.on_a(), simplex.on_b()}, a, b);
}

void make_penetration(Clearance& clearance, double width)
{
    clearance.distance = -clearance.distance - width;
    clearance.normal = -clearance.normal;
    clearance.on_a = clearance.on_b - clearance.distance * clearance.normal;
}

} // namespace fettle::robot
