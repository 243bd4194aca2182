#pragma once

// What a search through a box tree does with eight boxes or triangles at a time. Only for the search itself.

#include "mesh/box_tree.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

// Vectors go nowhere but into functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace fettle {

inline constexpr double kEpsilon = std::numeric_limits<float>::epsilon() / 2; // most of a rounding, relative

// Operations in float on the way to a distance, or to where a ray meets a box, are fewer than this, each off by a
// rounding of numbers no larger than the way.
inline constexpr double kRoundings = 16;
// Squared sine at a corner below which float tells too little of a triangle: double must. At that sine the direction of
// the normal is 16 times less certain than its parts are.
inline constexpr float kNarrow = 1.0f / 256;
inline constexpr float kTriangleRoundings = static_cast<float>(16 * kRoundings * kEpsilon);

// Every visit of a node leaves seven more to visit, and there are at most eleven levels over 2^32 triangles.
inline constexpr std::size_t kMostWaiting = 7 * 11 + 1;

#define FETTLE_INLINE [[gnu::always_inline]] inline

FETTLE_INLINE Float8 larger(Float8 a, Float8 b) { return a > b ? a : b; }
FETTLE_INLINE Float8 smaller(Float8 a, Float8 b) { return a < b ? a : b; }
FETTLE_INLINE Float8 all(float value) { return Float8{} + value; }

struct Point8 {
    Float8 x, y, z;
};
FETTLE_INLINE Point8 operator-(const Point8& a, const Point8& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
FETTLE_INLINE Float8 dot(const Point8& a, const Point8& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FETTLE_INLINE Point8 cross(const Point8& a, const Point8& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The lanes in which a mask is set, a bit each.
FETTLE_INLINE unsigned lanes_of(Mask8 mask)
{
    // Pairs of lanes are taken as words: the bits of the even lanes come together in the lower halves.
    using Words = std::uint64_t __attribute__((vector_size(32)));
    const Mask8 bits = mask & Mask8{1, 2, 4, 8, 16, 32, 64, 128};
    const Words words = std::bit_cast<Words>(bits);
    const std::uint64_t word = (words[0] | words[2]) | (words[1] | words[3]);
    return static_cast<unsigned>(word | word >> 32);
}

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

/// Squared distance of the origin to the segments from a along ab. Segments without length are points.
FETTLE_INLINE Float8 squared_distance(const Point8& a, const Point8& ab, Float8 squared_length)
{
    Float8 t = -dot(a, ab) / squared_length;
    t = t > 0 ? t : Float8{}; // NaN too
    t = t < 1 ? t : all(1);
    const Point8 foot = {a.x + t * ab.x, a.y + t * ab.y, a.z + t * ab.z};
    return dot(foot, foot);
}

/// A lower bound of the squared distance of a point to eight triangles, exact but for roundings; below 0 for the narrow
/// ones.
FETTLE_INLINE Float8 squared_distance(const Triangles8& triangles, const float (&point)[3])
{
    const auto corner = [&](int k) -> Point8 {
        return {triangles.corner[k][0] - point[0], triangles.corner[k][1] - point[1],
                triangles.corner[k][2] - point[2]};
    };
    const Point8 a = corner(0), b = corner(1), c = corner(2);
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
    const Float8 nearest = over ? height * height / normal2 : to_edges;
    // The distance d is off by less than k (d + longest), with k = kTriangleRoundings: its square by 3 k d² + k
    // longest².
    const Float8 least = nearest * (1 - 3 * kTriangleRoundings) - kTriangleRoundings * longest2;
    return normal2 > kNarrow * longest2 * longest2 ? least : all(-1);
}

/// A node or, at level -1, a leaf that waits to be visited.
struct Waiting {
    float distance;
    std::int32_t level;
    std::uint32_t index;
};

/// Lanes out of lanes_of(), one by one.
struct Lanes {
    unsigned bits;

    FETTLE_INLINE bool any() const { return bits != 0; }
    FETTLE_INLINE unsigned first() const { return static_cast<unsigned>(std::countr_zero(bits)); }
    FETTLE_INLINE void next() { bits &= bits - 1; }
};

/// Nodes to visit, the nearest of the last visited node's children first.
class Stack {
  public:
    explicit Stack(const BoxTree& tree)
    {
        waiting_[size_++] = {0, static_cast<std::int32_t>(tree.levels.size()) - 1, 0};
    }

    FETTLE_INLINE bool any() const { return size_ > 0; }
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
