#pragma once

// Solids as a search through a box tree sees them: signed distances of eight points, boxes or triangles at a time, in
// float. Only for the search itself.

#include "mesh/box_search.h"
#include "mesh/box_tree.h"
#include "mesh/lanes.h"
#include "robot/clearance.h"

#include <algorithm>
#include <cmath>

namespace fettle {

/// Signed distances with their gradients: tangent planes that no point of the solid's distance lies below.
struct Distance8 {
    Float8 value;
    Point8 gradient;
};

struct WideSphere {
    WideSphere(const RoundSolid& solid, const Eigen::Vector3d& about)
        : radius(static_cast<float>(solid.rounding)),
          size(solid.rounding + (solid.T.translation() - about).cwiseAbs().maxCoeff())
    {
        Eigen::Vector3f::Map(centre) = (solid.T.translation() - about).cast<float>();
    }

    float centre[3], radius;
    static constexpr bool exact = true;
    double size; ///< of the numbers it reckons with, mm
};

/// A round solid. That of a tapered one is taken as the largest of its distances from three cones and planes: never
/// more than it is.
struct WideRound {
    WideRound(const RoundSolid& solid, const Eigen::Vector3d& centre)
        : radius(static_cast<float>(solid.radius_from)), length(static_cast<float>(solid.length)),
          rounding(static_cast<float>(solid.rounding)), exact(solid.radius_from == solid.radius_to)
    {
        Eigen::Vector3f::Map(origin) = (solid.T.translation() - centre).cast<float>();
        Eigen::Vector3f::Map(axis) = solid.T.linear().col(2).cast<float>();
        const double taper = solid.radius_from - solid.radius_to, side = std::hypot(solid.length, taper);
        if (side > 0) {
            out_r = static_cast<float>(solid.length / side);
            out_z = static_cast<float>(taper / side);
        }
        size = solid.length + std::max(solid.radius_from, solid.radius_to) + solid.rounding +
               (solid.T.translation() - centre).cwiseAbs().maxCoeff();
    }

    FETTLE_INLINE Distance8 operator()(const Point8& point) const
    {
        const Point8 w = point - all(origin), a = all(axis);
        const Float8 z = dot(w, a);
        const Point8 across = {w.x - z * a.x, w.y - z * a.y, w.z - z * a.z};
        const Float8 r = root(dot(across, across));
        const Mask8 upper = z - length > -z;
        const Float8 beyond = upper ? z - length : -z, zero = {};
        Float8 along_r, along_z, value;
        const Float8 beside = !exact ? (r - radius) * out_r + z * out_z : r - radius;
        const Mask8 by_end = beyond > beside;
        if (!exact) {
            value = larger(beyond, beside);
            along_r = by_end ? zero : all(out_r);
            along_z = by_end ? (upper ? all(1) : all(-1)) : all(out_z);
        } else {
            const Float8 out = larger(beside, zero), over = larger(beyond, zero);
            const Float8 outside = root(out * out + over * over);
            value = outside + smaller(larger(beyond, beside), zero);
            const Mask8 is_outside = outside > 0;
            along_r = is_outside ? out / outside : (by_end ? zero : all(1));
            const Float8 end = is_outside ? over / outside : (by_end ? all(1) : zero);
            along_z = upper ? end : -end;
        }
        const Float8 outwards = r > 0 ? along_r / r : zero;
        return {value - rounding,
                {outwards * across.x + along_z * a.x, outwards * across.y + along_z * a.y,
                 outwards * across.z + along_z * a.z}};
    }

    float origin[3], axis[3], radius, length, rounding;
    float out_r = 1, out_z = 0; ///< of the slanted side
    bool exact;                 ///< or else the distance may be too small
    double size;                ///< of the numbers it reckons with, mm
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

    FETTLE_INLINE Distance8 operator()(const Point8& point) const
    {
        const Point8 w = point - all(origin);
        const Float8 zero = {};
        Float8 q[3], beyond[3], outside2 = {};
        for (int k = 0; k < 3; ++k) {
            q[k] = dot(w, all(axes[k]));
            beyond[k] = larger(q[k], -q[k]) - half[k];
            const Float8 out = larger(beyond[k], zero);
            outside2 += out * out;
        }
        const Float8 outside = root(outside2), most = larger(beyond[0], larger(beyond[1], beyond[2]));
        Distance8 found = {outside + smaller(most, zero), {}};
        Mask8 deepest = most == most; // the first side of those that are equally deep
        for (int k = 0; k < 3; ++k) {
            const Mask8 this_one = deepest & (beyond[k] >= most);
            deepest &= ~this_one;
            const Float8 along = outside > 0 ? larger(beyond[k], zero) / outside : (this_one ? all(1) : zero);
            const Float8 signed_along = q[k] < 0 ? -along : along;
            const Point8 axis = all(axes[k]);
            found.gradient =
                found.gradient + Point8{signed_along * axis.x, signed_along * axis.y, signed_along * axis.z};
        }
        return found;
    }

    float origin[3], half[3], axes[3][3];
    bool exact; ///< or else the distance may be too small
    double size;
};

FETTLE_INLINE Float8 magnitude(Float8 a) { return larger(a, -a); }

/// No point of eight boxes is nearer. NaN for those that are not there.
template <typename Wide>
FETTLE_INLINE Float8 lower_bound(const Wide& solid, const Boxes8& boxes)
{
    const Point8 least = {boxes.least[0], boxes.least[1], boxes.least[2]},
                 sizes = Point8{boxes.most[0], boxes.most[1], boxes.most[2]} - least,
                 half = {sizes.x * 0.5f, sizes.y * 0.5f, sizes.z * 0.5f};
    const Distance8 at = solid(least + half);
    const Point8 slope = {magnitude(at.gradient.x), magnitude(at.gradient.y), magnitude(at.gradient.z)};
    return at.value - dot(slope, half);
}

FETTLE_INLINE Float8 lower_bound(const WideSphere& sphere, const Level& level, std::size_t node)
{
    return root(squared_distance(level, node, sphere.centre)) - sphere.radius;
}

/// The same of eight discs.
template <typename Wide>
FETTLE_INLINE Float8 lower_bound(const Wide& solid, const Discs8& discs)
{
    const Distance8 at = solid(Point8{discs.centre[0], discs.centre[1], discs.centre[2]});
    const Float8 along = dot(at.gradient, Point8{discs.normal[0], discs.normal[1], discs.normal[2]});
    const Float8 beside = root(larger(all(1 + kDiscRoundings) - along * along, Float8{}));
    return at.value - magnitude(along) * discs.half - beside * discs.radius;
}

template <typename Wide>
FETTLE_INLINE Float8 lower_bound(const Wide& solid, const Level& level, std::size_t node)
{
    const Float8 of_boxes = lower_bound(solid, level.boxes[node]);
    if (level.discs.empty()) return of_boxes;
    const Float8 of_discs = lower_bound(solid, level.discs[node]);
    return of_discs > of_boxes ? of_discs : of_boxes; // NaN if the box is
}

/// Between these lie the least distances of eight triangles.
struct Least8 {
    Float8 lower, upper;
};
template <typename Wide>
FETTLE_INLINE Least8 least_of_triangles(const Wide& solid, const Triangles8& triangles)
{
    const Point8 a = corner(triangles, 0), b = corner(triangles, 1), c = corner(triangles, 2), sum = a + b + c;
    const float third = 1.0f / 3;
    const Point8 middle = {sum.x * third, sum.y * third, sum.z * third};
    const Distance8 at = solid(middle);
    const Float8 way =
        smaller(dot(at.gradient, a - middle), smaller(dot(at.gradient, b - middle), dot(at.gradient, c - middle)));
    return {at.value + way, at.value};
}

FETTLE_INLINE Least8 least_of_triangles(const WideSphere& sphere, const Triangles8& triangles)
{
    const Bounds8 squared = squared_distances(triangles, sphere.centre);
    return {root(larger(squared.least, Float8{})) - sphere.radius, root(squared.most) - sphere.radius};
}

} // namespace fettle
