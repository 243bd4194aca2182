#pragma once

// Solids for the search in a box tree: signed distances of eight points, boxes or triangles at a time, in float (SIMD).
// Used by workpiece.cc only.

#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "mesh/lanes.h"
#include "robot/clearance.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

/// Signed distances of eight points and their gradients. The distance is convex, so its tangent plane at a point is a
/// lower bound everywhere.
struct Distance8 {
    mesh::Float8 value;
    mesh::Point8 gradient;
};

struct WideSphere {
    /// @param origin  of the tree's coordinates
    WideSphere(const RoundSolid& solid, const Eigen::Vector3d& origin)
        : radius(solid.rounding), size(solid.rounding + (solid.T.translation() - origin).cwiseAbs().maxCoeff())
    {
        Eigen::Vector3f::Map(centre) = (solid.T.translation() - origin).cast<float>();
    }

    float centre[3], radius;
    static constexpr bool exact = true;
    double size; ///< bound of the coordinates, mm: rounding errors are proportional to it
};

/// A round solid. The distance from a tapered one is replaced by a lower bound, the largest of its distances from the
/// mantle's cone and the planes of the ends.
struct WideRound {
    WideRound(const RoundSolid& solid, const Eigen::Vector3d& centre)
        : radius(solid.radius_from), length(solid.length), rounding(solid.rounding),
          exact(solid.radius_from == solid.radius_to)
    {
        Eigen::Vector3f::Map(origin) = (solid.T.translation() - centre).cast<float>();
        Eigen::Vector3f::Map(axis) = solid.T.linear().col(2).cast<float>();
        const double taper = solid.radius_from - solid.radius_to, side = std::hypot(solid.length, taper);
        if (side > 0) {
            normal_r = static_cast<float>(solid.length / side);
            normal_z = static_cast<float>(taper / side);
        }
        size = solid.length + std::max(solid.radius_from, solid.radius_to) + solid.rounding +
               (solid.T.translation() - centre).cwiseAbs().maxCoeff();
    }

    FETTLE_INLINE Distance8 operator()(const mesh::Point8& point) const
    {
        const mesh::Point8 w = point - mesh::broadcast(origin), a = mesh::broadcast(axis);
        const mesh::Float8 z = mesh::dot(w, a);
        const mesh::Point8 across = {w.x - z * a.x, w.y - z * a.y, w.z - z * a.z};
        const mesh::Float8 r = mesh::cwise_sqrt(mesh::dot(across, across));
        const mesh::Mask8 upper = z - length > -z;
        const mesh::Float8 from_end = upper ? z - length : -z, zero = {};
        mesh::Float8 gradient_r, gradient_z, value;
        const mesh::Float8 from_side = !exact ? (r - radius) * normal_r + z * normal_z : r - radius;
        const mesh::Mask8 nearer_end = from_end > from_side;
        if (!exact) {
            value = mesh::cwise_max(from_end, from_side);
            gradient_r = nearer_end ? zero : mesh::broadcast(normal_r);
            gradient_z = nearer_end ? (upper ? mesh::broadcast(1) : mesh::broadcast(-1)) : mesh::broadcast(normal_z);
        } else {
            const mesh::Float8 off_side = mesh::cwise_max(from_side, zero), off_end = mesh::cwise_max(from_end, zero);
            const mesh::Float8 outside = mesh::cwise_sqrt(off_side * off_side + off_end * off_end);
            value = outside + mesh::cwise_min(mesh::cwise_max(from_end, from_side), zero);
            const mesh::Mask8 is_outside = outside > 0;
            gradient_r = is_outside ? off_side / outside : (nearer_end ? zero : mesh::broadcast(1));
            const mesh::Float8 end = is_outside ? off_end / outside : (nearer_end ? mesh::broadcast(1) : zero);
            gradient_z = upper ? end : -end;
        }
        const mesh::Float8 over_r = r > 0 ? gradient_r / r : zero;
        return {value - rounding,
                {over_r * across.x + gradient_z * a.x, over_r * across.y + gradient_z * a.y,
                 over_r * across.z + gradient_z * a.z}};
    }

    float origin[3], axis[3], radius, length, rounding;
    float normal_r = 1, normal_z = 0; ///< outward normal of the slanted side
    bool exact;                       ///< false: the distance is a lower bound
    double size;                      ///< bound of the coordinates, mm
};

/// The points no farther than its radius from a segment.
struct WideCapsule {
    WideCapsule(const RoundSolid& solid, const Eigen::Vector3d& centre)
        : length(solid.length), radius(solid.rounding),
          size(solid.length + solid.rounding + (solid.T.translation() - centre).cwiseAbs().maxCoeff())
    {
        Eigen::Vector3f::Map(origin) = (solid.T.translation() - centre).cast<float>();
        Eigen::Vector3f::Map(axis) = solid.T.linear().col(2).cast<float>();
    }

    FETTLE_INLINE Distance8 operator()(const mesh::Point8& point) const
    {
        const mesh::Point8 w = point - mesh::broadcast(origin), a = mesh::broadcast(axis);
        const mesh::Float8 z =
            mesh::cwise_min(mesh::cwise_max(mesh::dot(w, a), mesh::Float8{}), mesh::broadcast(length));
        const mesh::Point8 from_segment = {w.x - z * a.x, w.y - z * a.y, w.z - z * a.z};
        const mesh::Float8 distance = mesh::cwise_sqrt(mesh::dot(from_segment, from_segment));
        const mesh::Float8 scale = distance > 0 ? 1 / distance : mesh::Float8{};
        return {distance - radius, {from_segment.x * scale, from_segment.y * scale, from_segment.z * scale}};
    }

    float origin[3], axis[3], length, radius;
    static constexpr bool exact = true;
    double size; ///< bound of the coordinates, mm
};

struct WideBox {
    WideBox(const BoxSolid& box, const Eigen::Vector3d& centre)
    {
        Eigen::Vector3f::Map(origin) = (box.T.translation() - centre).cast<float>();
        Eigen::Vector3f::Map(half) = box.half.cast<float>();
        for (int k = 0; k < 3; ++k) Eigen::Vector3f::Map(axes[k]) = box.T.linear().col(k).cast<float>();
        exact = box.exact;
        size = 2 * box.half.sum() + (box.T.translation() - centre).cwiseAbs().maxCoeff();
    }

    FETTLE_INLINE Distance8 operator()(const mesh::Point8& point) const
    {
        const mesh::Point8 w = point - mesh::broadcast(origin);
        const mesh::Float8 zero = {};
        mesh::Float8 q[3], excess[3], outside2 = {};
        for (int k = 0; k < 3; ++k) {
            q[k] = mesh::dot(w, mesh::broadcast(axes[k]));
            excess[k] = mesh::cwise_max(q[k], -q[k]) - half[k];
            const mesh::Float8 off = mesh::cwise_max(excess[k], zero);
            outside2 += off * off;
        }
        const mesh::Float8 outside = mesh::cwise_sqrt(outside2),
                           max = mesh::cwise_max(excess[0], mesh::cwise_max(excess[1], excess[2]));
        Distance8 found = {outside + mesh::cwise_min(max, zero), {}};
        mesh::Mask8 undecided = max == max; // inside, the first of equally near sides gives the gradient
        for (int k = 0; k < 3; ++k) {
            const mesh::Mask8 is_nearest = undecided & (excess[k] >= max);
            undecided &= ~is_nearest;
            const mesh::Float8 along =
                outside > 0 ? mesh::cwise_max(excess[k], zero) / outside : (is_nearest ? mesh::broadcast(1) : zero);
            const mesh::Float8 signed_along = q[k] < 0 ? -along : along;
            const mesh::Point8 axis = mesh::broadcast(axes[k]);
            found.gradient =
                found.gradient + mesh::Point8{signed_along * axis.x, signed_along * axis.y, signed_along * axis.z};
        }
        return found;
    }

    float origin[3], half[3], axes[3][3];
    bool exact;  ///< false: the distance is a lower bound
    double size; ///< bound of the coordinates, mm
};

FETTLE_INLINE mesh::Float8 magnitude(mesh::Float8 a) { return mesh::cwise_max(a, -a); }

/// Lower bounds of the distances of eight boxes; NaN for empty boxes.
template <typename Wide>
FETTLE_INLINE mesh::Float8 lower_bound(const Wide& solid, const mesh::Boxes8& boxes)
{
    const mesh::Point8 min = {boxes.min[0], boxes.min[1], boxes.min[2]},
                       sizes = mesh::Point8{boxes.max[0], boxes.max[1], boxes.max[2]} - min,
                       half = {sizes.x * 0.5f, sizes.y * 0.5f, sizes.z * 0.5f};
    const Distance8 centre = solid(min + half);
    const mesh::Point8 slope = {magnitude(centre.gradient.x), magnitude(centre.gradient.y),
                                magnitude(centre.gradient.z)};
    return centre.value - mesh::dot(slope, half);
}

FETTLE_INLINE mesh::Float8 lower_bound(const WideSphere& sphere, const mesh::TreeLevel& level, std::size_t node)
{
    return mesh::cwise_sqrt(mesh::squared_distance(level, node, sphere.centre)) - sphere.radius;
}

/// Lower bounds of the distances of eight discs.
template <typename Wide>
FETTLE_INLINE mesh::Float8 lower_bound(const Wide& solid, const mesh::Discs8& discs)
{
    const Distance8 centre = solid(mesh::Point8{discs.centre[0], discs.centre[1], discs.centre[2]});
    const mesh::Float8 along =
        mesh::dot(centre.gradient, mesh::Point8{discs.normal[0], discs.normal[1], discs.normal[2]});
    const mesh::Float8 across = mesh::cwise_sqrt(
        mesh::cwise_max(mesh::broadcast(1 + mesh::kBoundRoundingError) - along * along, mesh::Float8{}));
    return centre.value - magnitude(along) * discs.half_thickness - across * discs.radius;
}

template <typename Wide>
FETTLE_INLINE mesh::Float8 lower_bound(const Wide& solid, const mesh::TreeLevel& level, std::size_t node)
{
    const mesh::Float8 to_boxes = lower_bound(solid, level.boxes[node]);
    if (level.discs.empty()) return to_boxes;
    const mesh::Float8 to_discs = lower_bound(solid, level.discs[node]);
    return to_discs > to_boxes ? to_discs : to_boxes; // NaN for an empty box
}

/// Bounds of the minimum distances of eight triangles.
struct MinDistance8 {
    mesh::Float8 lower, upper;
};
template <typename Wide>
FETTLE_INLINE MinDistance8 min_distances(const Wide& solid, const mesh::Triangles8& triangles)
{
    const mesh::Point8 a = mesh::corner(triangles, 0), b = mesh::corner(triangles, 1), c = mesh::corner(triangles, 2),
                       sum = a + b + c;
    const float third = 1.0f / 3;
    const mesh::Point8 centroid = {sum.x * third, sum.y * third, sum.z * third};
    const Distance8 at = solid(centroid);
    const mesh::Float8 descent =
        mesh::cwise_min(mesh::dot(at.gradient, a - centroid),
                        mesh::cwise_min(mesh::dot(at.gradient, b - centroid), mesh::dot(at.gradient, c - centroid)));
    return {at.value + descent, at.value};
}

FETTLE_INLINE MinDistance8 min_distances(const WideSphere& sphere, const mesh::Triangles8& triangles)
{
    const mesh::Bounds8 squared = mesh::squared_distances(triangles, sphere.centre);
    return {mesh::cwise_sqrt(mesh::cwise_max(squared.lower, mesh::Float8{})) - sphere.radius,
            mesh::cwise_sqrt(squared.upper) - sphere.radius};
}

} // namespace fettle::robot
