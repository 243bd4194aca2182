#pragma once

#include "robot/clearance.h"

#include <Eigen/Core>

#include <array>

// Points of the difference of two cores, and the nearest one to the origin of their hull. For the search alone.
namespace fettle {

/// A point of a, one of b, and b - a.
struct DifferencePoint {
    Eigen::Vector3d w, on_a, on_b;
};

/// The point of b - a that is farthest along `direction`.
inline DifferencePoint farthest_difference(const PlacedSolid& a, const PlacedSolid& b, const Eigen::Vector3d& direction)
{
    const Eigen::Vector3d on_a = a.farthest(-direction), on_b = b.farthest(direction);
    return {on_b - on_a, on_a, on_b};
}

/// One to four points; `weight` are those of the point of their hull that is nearest to the origin.
struct Simplex {
    std::array<DifferencePoint, 4> point;
    std::array<double, 4> weight{};
    int count = 0;

    void add(const DifferencePoint& p) { point[static_cast<std::size_t>(count++)] = p; }
    Eigen::Vector3d nearest() const;
    Eigen::Vector3d on_a() const;
    Eigen::Vector3d on_b() const;
};

/// Finds the nearest point and drops the points that it does not need.
/// @param outside  is it certain that the origin lies outside? Roundings of a flat tetrahedron may say otherwise.
/// @return  does the origin lie inside a tetrahedron?
bool reduce(Simplex& simplex, bool outside = false);

} // namespace fettle
