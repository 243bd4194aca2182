#pragma once

#include "robot/clearance.h"

#include <Eigen/Core>

#include <array>

// The simplex of the GJK and EPA algorithms: points of the Minkowski difference b - a of two cores, and the point of
// their hull that is nearest to the origin. Used by clearance.cc, depth.cc and hull_points.cc only.
namespace fettle::robot {

/// A point of the Minkowski difference b - a, with the points of a and b that it comes from.
struct DifferencePoint {
    Eigen::Vector3d w, on_a, on_b;
};

/// Support mapping of the Minkowski difference: its point that is farthest along `direction`.
inline DifferencePoint difference_support(const PlacedSolid& a, const PlacedSolid& b, const Eigen::Vector3d& direction)
{
    const Eigen::Vector3d on_a = a.support(-direction), on_b = b.support(direction);
    return {on_b - on_a, on_a, on_b};
}

/// One to four points. After reduce() `weight` holds the barycentric coordinates of the point of their hull that is
/// nearest to the origin.
struct Simplex {
    std::array<DifferencePoint, 4> point;
    std::array<double, 4> weight{};
    int count = 0;

    void add(const DifferencePoint& p) { point[count++] = p; }
    Eigen::Vector3d nearest() const { return weighted_sum(&DifferencePoint::w); }
    Eigen::Vector3d on_a() const { return weighted_sum(&DifferencePoint::on_a); }
    Eigen::Vector3d on_b() const { return weighted_sum(&DifferencePoint::on_b); }

  private:
    Eigen::Vector3d weighted_sum(Eigen::Vector3d DifferencePoint::*part) const
    {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int i = 0; i < count; ++i) sum += weight[i] * point[i].*part;
        return sum;
    }
};

/// Computes the point nearest to the origin and drops the vertices that have no weight in it.
/// @param outside  true if the origin is known to lie outside: rounding of a flat tetrahedron may hide this
/// @return  true if the origin lies inside a tetrahedron
bool reduce(Simplex& simplex, bool outside = false);

} // namespace fettle::robot
