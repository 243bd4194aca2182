#pragma once

// What a search through a box tree does with eight boxes or triangles at a time. Only for the search itself.

#include "mesh/box_tree.h"
#include "mesh/lanes.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace fettle {

// Squared sine at a corner below which float tells too little of a triangle: double must. At that sine the direction of
// the normal is 16 times less certain than its parts are.
inline constexpr float kNarrow = 1.0f / 256;
inline constexpr float kTriangleRoundings = static_cast<float>(16 * kRoundings * kEpsilon);

// Every visit of a node leaves seven more to visit, and there are at most eleven levels over 2^32 triangles.
inline constexpr std::size_t kMostWaiting = 7 * 11 + 1;

/// Squared distance of a point to eight boxes; infinite for those that are not there.
FETTLE_INLINE Float8 squared_distance(const Boxes8& boxes, const float (&point)[3])
{
    Float8 sum = {};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 p = all(point[axis]);
        const Float8 beside = larger(larger(boxes.least[axis] - p, p - boxes.most[axis]), Float8{});
        sum += beside * beside;
    }
    return sum;
}

/// The same to eight discs.
FETTLE_INLINE Float8 squared_distance(const Discs8& discs, const float (&point)[3])
{
    const auto& [x, y, z] = discs.centre;
    const auto& [nx, ny, nz] = discs.normal;
    const Point8 way = Point8{x, y, z} - all(point);
    const Float8 above = dot(way, {nx, ny, nz});
    const Float8 beside2 = dot(way, way) * (1 - kDiscRoundings) - above * above;
    const Float8 over = larger(larger(above, -above) - discs.half, Float8{});
    const Float8 beyond = larger(root(larger(beside2, Float8{})) - discs.radius, Float8{});
    return over * over + beyond * beyond;
}

/// The same to the children of a node.
FETTLE_INLINE Float8 squared_distance(const Level& level, std::size_t node, const float (&point)[3])
{
    const Float8 to_boxes = squared_distance(level.boxes[node], point);
    return level.discs.empty() ? to_boxes : larger(to_boxes, squared_distance(level.discs[node], point));
}

/// Squared distance of the origin to the segments from a along ab. Segments without length are points.
FETTLE_INLINE Float8 squared_distance(const Point8& a, const Point8& ab, Float8 squared_length)
{
    Float8 t = -dot(a, ab) / squared_length;
    t = t > 0 ? t : Float8{}; // NaN too
    t = t < 1 ? t : all(1.0f);
    const Point8 foot = {a.x + t * ab.x, a.y + t * ab.y, a.z + t * ab.z};
    return dot(foot, foot);
}

/// Between these bounds lie the squared distances of a point to eight triangles.
struct Bounds8 {
    Float8 least; ///< below 0 for narrow triangles
    Float8 most;
};
FETTLE_INLINE Bounds8 squared_distances(const Triangles8& triangles, const float (&point)[3])
{
    const Point8 origin = all(point);
    const Point8 a = corner(triangles, 0) - origin, b = corner(triangles, 1) - origin,
                 c = corner(triangles, 2) - origin;
    const Point8 ab = b - a, bc = c - b, ca = a - c;
    const Float8 ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
    const Float8 longest2 = larger(ab2, larger(bc2, ca2));
    const Point8 normal = cross(ab, bc);
    const Float8 normal2 = dot(normal, normal);
    const Float8 height = dot(a, normal);
    const Mask8 over =
        (dot(cross(a, ab), normal) > 0) & (dot(cross(b, bc), normal) > 0) & (dot(cross(c, ca), normal) > 0);
    const Float8 to_edges =
        smaller(squared_distance(a, ab, ab2), smaller(squared_distance(b, bc, bc2), squared_distance(c, ca, ca2)));
    const Mask8 wide = normal2 > kNarrow * longest2 * longest2;
    const Float8 nearest = (over & wide) ? height * height / normal2 : to_edges;
    // The distance d is off by less than k (d + longest), with k = kTriangleRoundings: its square by 3 k d² + k
    // longest².
    const Float8 off = kTriangleRoundings * (3 * nearest + longest2);
    return {wide ? nearest - off : all(-1.0f), nearest + off};
}

/// A node or, at level -1, a leaf that waits to be visited.
struct Waiting {
    float distance;
    std::int32_t level;
    std::uint32_t index;
};

/// Nodes to visit, the nearest of the last visited node's children first.
class Stack {
  public:
    FETTLE_INLINE bool any() const { return size_ > 0; }
    FETTLE_INLINE void push(const Waiting& node) { waiting_[size_++] = node; }
    FETTLE_INLINE const Waiting& pop() { return waiting_[--size_]; }

    /// Children of a node.
    FETTLE_INLINE void push(unsigned lanes, const Float8& distances, std::int32_t level, std::uint32_t node)
    {
        const std::size_t first = size_;
        for (Lanes left{lanes}; left.any(); left.next()) {
            const float distance = distances[left.first()];
            std::size_t place = size_++;
            for (; place > first && waiting_[place - 1].distance < distance; --place)
                waiting_[place] = waiting_[place - 1];
            waiting_[place].distance = distance;
            waiting_[place].level = level;
            waiting_[place].index = 8 * node + left.first();
        }
    }

  private:
    std::array<Waiting, kMostWaiting> waiting_;
    std::size_t size_ = 0;
};

} // namespace fettle
