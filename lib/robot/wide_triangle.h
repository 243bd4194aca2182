#pragma once

// Distances of a triangle from eight triangles at a time, and of a box from eight boxes in another frame, in float
// (SIMD). Used by mesh_clearance.cc only.

#include "mesh/box_tree.h"
#include "mesh/lanes.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace fettle::robot {

/// A rigid motion from the coordinates of one tree to those of another.
struct WideMotion {
    explicit WideMotion(const Eigen::Isometry3d& T)
    {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                rotation[row][column] = static_cast<float>(T.linear()(row, column));
            translation[row] = static_cast<float>(T.translation()[row]);
        }
    }

    FETTLE_INLINE mesh::Point8 operator()(const mesh::Point8& p) const
    {
        mesh::Float8 q[3];
        for (int k = 0; k < 3; ++k)
            q[k] = rotation[k][0] * p.x + rotation[k][1] * p.y + rotation[k][2] * p.z + translation[k];
        return {q[0], q[1], q[2]};
    }

    /// The motion of coordinates relative to a point, to such relative to another.
    FETTLE_INLINE WideMotion between(const float (&from)[3], const float (&to)[3]) const
    {
        WideMotion motion = *this;
        for (int k = 0; k < 3; ++k)
            motion.translation[k] +=
                rotation[k][0] * from[0] + rotation[k][1] * from[1] + rotation[k][2] * from[2] - to[k];
        return motion;
    }

    float rotation[3][3], translation[3];
};

/// A box along the axes of a tree's coordinates.
struct FlatBox {
    float centre[3], half[3];
};

/// Lower bounds of the signed distances of a box from eight boxes, by the axes of either (Gottschalk, Lin & Manocha
/// 1996, without the products of edges); NaN for empty boxes.
/// @param motion  from the coordinates of `box` to those of `boxes`
FETTLE_INLINE mesh::Float8 box_distances(const mesh::Boxes8& boxes, const FlatBox& box, const WideMotion& motion)
{
    mesh::Float8 delta[3], half[3], outside[2] = {}, highest[2] = {};
    for (int k = 0; k < 3; ++k) {
        const float(&row)[3] = motion.rotation[k];
        const float centre =
            row[0] * box.centre[0] + row[1] * box.centre[1] + row[2] * box.centre[2] + motion.translation[k];
        const float extent =
            std::abs(row[0]) * box.half[0] + std::abs(row[1]) * box.half[1] + std::abs(row[2]) * box.half[2];
        half[k] = (boxes.max[k] - boxes.min[k]) * 0.5f;
        delta[k] = (boxes.max[k] + boxes.min[k]) * 0.5f - centre;
        const mesh::Float8 excess = mesh::cwise_max(delta[k], -delta[k]) - half[k] - extent,
                           off = mesh::cwise_max(excess, mesh::Float8{});
        outside[0] += off * off;
        highest[0] = k == 0 ? excess : mesh::cwise_max(highest[0], excess);
    }
    for (int k = 0; k < 3; ++k) {
        mesh::Float8 along = {}, extent = {};
        for (int j = 0; j < 3; ++j) {
            along += motion.rotation[j][k] * delta[j];
            extent += std::abs(motion.rotation[j][k]) * half[j];
        }
        const mesh::Float8 excess = mesh::cwise_max(along, -along) - extent - box.half[k],
                           off = mesh::cwise_max(excess, mesh::Float8{});
        outside[1] += off * off;
        highest[1] = k == 0 ? excess : mesh::cwise_max(highest[1], excess);
    }
    mesh::Float8 distance[2];
    for (int side = 0; side < 2; ++side)
        distance[side] = mesh::cwise_sqrt(outside[side]) + mesh::cwise_min(highest[side], mesh::Float8{});
    const mesh::Float8 larger = mesh::cwise_max(distance[0], distance[1]);
    return boxes.min[0] <= std::numeric_limits<float>::max() ? larger
                                                             : mesh::broadcast(std::numeric_limits<float>::quiet_NaN());
}

/// Bounds of the signed distances of eight pairs of triangles.
struct TriangleBounds8 {
    mesh::Float8 lower, upper;
};

/// The shortest of some vectors, each from a point of one triangle to a point of the other.
struct Shortest8 {
    mesh::Point8 vector = {};
    mesh::Float8 squared = mesh::broadcast(std::numeric_limits<float>::max());

    FETTLE_INLINE void offer(const mesh::Point8& w, mesh::Mask8 counts)
    {
        const mesh::Float8 length2 = mesh::dot(w, w);
        const mesh::Mask8 shorter = counts & (length2 < squared);
        squared = shorter ? length2 : squared;
        vector = {shorter ? w.x : vector.x, shorter ? w.y : vector.y, shorter ? w.z : vector.z};
    }
};

FETTLE_INLINE mesh::Float8 clamp_to_unit(mesh::Float8 t)
{
    t = t > 0 ? t : mesh::Float8{}; // NaN becomes 0, too
    return t < 1 ? t : mesh::broadcast(1.0f);
}

FETTLE_INLINE mesh::Point8 scaled(const mesh::Point8& a, mesh::Float8 s) { return {a.x * s, a.y * s, a.z * s}; }

/// Offers the shortest vector between the edges p + s d and q + t e.
FETTLE_INLINE void offer_edges(Shortest8& shortest, const mesh::Point8& p, const mesh::Point8& d, const mesh::Point8& q,
                               const mesh::Point8& e)
{
    const mesh::Point8 r = p - q;
    const mesh::Float8 dd = mesh::dot(d, d), ee = mesh::dot(e, e), de = mesh::dot(d, e), dr = mesh::dot(d, r),
                       er = mesh::dot(e, r);
    const mesh::Float8 s0 = clamp_to_unit((de * er - dr * ee) / (dd * ee - de * de));
    const mesh::Float8 t = clamp_to_unit((de * s0 + er) / ee);
    const mesh::Float8 s = clamp_to_unit((de * t - dr) / dd);
    shortest.offer(r + scaled(d, s) - scaled(e, t), s == s);
}

/// Offers the vectors between the plane of a triangle and points over it.
/// @param sign  1: from the triangle to the point
FETTLE_INLINE void offer_feet(Shortest8& shortest, const mesh::Point8 (&corner)[3], const mesh::Point8& point,
                              float sign)
{
    const mesh::Point8 normal = mesh::cross(corner[1] - corner[0], corner[2] - corner[0]), to = point - corner[0];
    mesh::Mask8 over = mesh::dot(normal, normal) > 0;
    for (int k = 0; k < 3; ++k)
        over &= mesh::dot(mesh::cross(corner[(k + 1) % 3] - corner[k], point - corner[k]), normal) > 0;
    shortest.offer(scaled(normal, sign * mesh::dot(to, normal) / mesh::dot(normal, normal)), over);
}

/// Bounds of the signed distances of pairs of triangles, but for rounding: above the length of a vector between points
/// of the two, below the gap across it. For the shortest vector both are the distance; a vector that rounding spoiled
/// only loosens the bounds.
FETTLE_INLINE TriangleBounds8 triangle_distances(const mesh::Point8 (&a)[3], const mesh::Point8 (&b)[3])
{
    Shortest8 shortest; // from b to a
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) offer_edges(shortest, a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]);
    for (int i = 0; i < 3; ++i) {
        offer_feet(shortest, b, a[i], 1);
        offer_feet(shortest, a, b[i], -1);
    }
    const mesh::Float8 length = mesh::cwise_sqrt(shortest.squared);
    const mesh::Point8 unit = scaled(shortest.vector, 1 / length);
    const mesh::Float8 lowest_a =
        mesh::cwise_min(mesh::dot(unit, a[0]), mesh::cwise_min(mesh::dot(unit, a[1]), mesh::dot(unit, a[2])));
    const mesh::Float8 highest_b =
        mesh::cwise_max(mesh::dot(unit, b[0]), mesh::cwise_max(mesh::dot(unit, b[1]), mesh::dot(unit, b[2])));
    const mesh::Float8 gap = lowest_a - highest_b;
    return {length > 0 ? gap : mesh::broadcast(-std::numeric_limits<float>::max()), length};
}

} // namespace fettle::robot
