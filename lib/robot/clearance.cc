#include "robot/clearance.h"

#include "robot/depth.h"
#include "robot/simplex.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Vector3d;

// Two curved rims need some fifty steps, corners a dozen.
constexpr int kMostSteps = 200;
// Upper and lower bound of a distance agree to within this, mm; nearer cores touch.
constexpr double kGap = 1e-9;
// Points of the difference that are nearer to each other than this share of their size are one.
constexpr double kSame = 1e-14;

bool holds(const Simplex& simplex, const Vector3d& w)
{
    const double near = kSame * w.squaredNorm();
    for (int i = 0; i < simplex.count; ++i)
        if ((simplex.point[static_cast<std::size_t>(i)].w - w).squaredNorm() <= near * kSame) return true;
    return false;
}

Clearance with_radii(Clearance cores, const PlacedSolid& a, const PlacedSolid& b)
{
    cores.distance -= a.radius() + b.radius();
    cores.on_a += a.radius() * cores.normal;
    cores.on_b -= b.radius() * cores.normal;
    return cores;
}

} // namespace

Clearance clearance(const PlacedSolid& a, const PlacedSolid& b, double beyond)
{
    const double radii = a.radius() + b.radius();
    Simplex simplex;
    simplex.add(farthest_difference(a, b, Vector3d::UnitX()));
    reduce(simplex);
    Vector3d v = simplex.nearest();
    for (int step = 0; step < kMostSteps; ++step) {
        const double length = v.norm();
        if (length <= kGap) return with_radii(core_depth(a, b, simplex), a, b);
        const DifferencePoint next = farthest_difference(a, b, -v);
        const double lower = v.dot(next.w) / length; // the plane there parts them by as much
        if (length - lower <= kGap || holds(simplex, next.w)) break;
        if (lower - radii > beyond) return {lower - radii, v / length, simplex.on_a(), simplex.on_b()};
        Simplex larger = simplex;
        larger.add(next);
        if (reduce(larger)) {
            if (!(lower > 0)) return with_radii(core_depth(a, b, larger), a, b);
            larger = simplex; // a plane parts them: the tetrahedron is as flat as roundings
            larger.add(next);
            reduce(larger, true);
        }
        const Vector3d nearer = larger.nearest();
        if (!(nearer.squaredNorm() < v.squaredNorm())) break; // roundings: no step leads nearer
        simplex = larger;
        v = nearer;
    }
    const double length = v.norm();
    return with_radii({length, v / length, simplex.on_a(), simplex.on_b()}, a, b);
}

} // namespace fettle
