#pragma once

// Distances from a point to eight boxes, discs or triangles at a time, and the stack of a depth-first search through a
// BoxTree. Internal to such searches.

#include "mesh/box_tree.h"
#include "mesh/lanes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace fettle::mesh {

// Squared sine of a triangle's angle below which its distance is computed in double only. At that sine the normal's
// direction is 16 times less accurate in float than the coordinates are.
inline constexpr float kMinSquaredSine = 1.0f / 256;
inline constexpr float kTriangleRoundingError = static_cast<float>(16 * kMaxRoundings * kFloatRoundoff);

// Each visited node is replaced by at most eight children, and a tree over 2^32 triangles has at most eleven levels.
inline constexpr std::size_t kMaxStackSize = 7 * 11 + 1;

/// Means "no triangle yet". It is larger than any index, so that every triangle wins a tie against it.
inline constexpr Eigen::Index kNoTriangle = std::numeric_limits<Eigen::Index>::max();

/// Squared distances from a point to eight boxes; infinite for empty boxes.
FETTLE_INLINE Float8 squared_distance(const Boxes8& boxes, const float (&point)[3])
{
    Float8 sum = {};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 p = broadcast(point[axis]);
        const Float8 outside = cwise_max(cwise_max(boxes.min[axis] - p, p - boxes.max[axis]), Float8{});
        sum += outside * outside;
    }
    return sum;
}

/// Squared distances from a point to eight discs.
FETTLE_INLINE Float8 squared_distance(const Discs8& discs, const float (&point)[3])
{
    const auto& [x, y, z] = discs.centre;
    const auto& [nx, ny, nz] = discs.normal;
    const Point8 to_centre = Point8{x, y, z} - broadcast(point);
    const Float8 axial = dot(to_centre, {nx, ny, nz});
    const Float8 radial2 = dot(to_centre, to_centre) * (1 - kBoundRoundingError) - axial * axial;
    const Float8 above = cwise_max(cwise_max(axial, -axial) - discs.half_thickness, Float8{});
    const Float8 beyond = cwise_max(cwise_sqrt(cwise_max(radial2, Float8{})) - discs.radius, Float8{});
    return above * above + beyond * beyond;
}

/// Lower bounds of the squared distances from a point to the children of a node.
FETTLE_INLINE Float8 squared_distance(const TreeLevel& level, std::size_t node, const float (&point)[3])
{
    const Float8 to_boxes = squared_distance(level.boxes[node], point);
    return level.discs.empty() ? to_boxes : cwise_max(to_boxes, squared_distance(level.discs[node], point));
}

/// Squared distances from the origin to the segments from a to a + ab. A segment of length 0 is a point.
FETTLE_INLINE Float8 squared_distance(const Point8& a, const Point8& ab, Float8 squared_length)
{
    Float8 t = -dot(a, ab) / squared_length;
    t = t > 0 ? t : Float8{}; // NaN becomes 0, too
    t = t < 1 ? t : broadcast(1.0f);
    const Point8 foot = {a.x + t * ab.x, a.y + t * ab.y, a.z + t * ab.z};
    return dot(foot, foot);
}

/// Bounds of the squared distances from a point to eight triangles.
struct Bounds8 {
    Float8 lower; ///< negative for triangles whose distance float cannot bound
    Float8 upper;
};
FETTLE_INLINE Bounds8 squared_distances(const Triangles8& triangles, const float (&point)[3])
{
    const Point8 origin = broadcast(point);
    const Point8 a = corner(triangles, 0) - origin, b = corner(triangles, 1) - origin,
                 c = corner(triangles, 2) - origin;
    const Point8 ab = b - a, bc = c - b, ca = a - c;
    const Float8 ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
    const Float8 longest2 = cwise_max(ab2, cwise_max(bc2, ca2));
    const Point8 normal = cross(ab, bc);
    const Float8 normal2 = dot(normal, normal);
    const Float8 height = dot(a, normal);
    const Mask8 foot_inside =
        (dot(cross(a, ab), normal) > 0) & (dot(cross(b, bc), normal) > 0) & (dot(cross(c, ca), normal) > 0);
    const Float8 to_edges =
        cwise_min(squared_distance(a, ab, ab2), cwise_min(squared_distance(b, bc, bc2), squared_distance(c, ca, ca2)));
    const Mask8 accurate = normal2 > kMinSquaredSine * longest2 * longest2;
    const Float8 squared = (foot_inside & accurate) ? height * height / normal2 : to_edges;
    // The error of the distance d is at most k (d + longest), with k = kTriangleRoundingError, and that of its square
    // at most 3 k d² + k longest².
    const Float8 error = kTriangleRoundingError * (3 * squared + longest2);
    return {accurate ? squared - error : broadcast(-1.0f), squared + error};
}

/// Bounds of the squared distances from a point to eight triangles as they are, not as they are packed.
FETTLE_INLINE Bounds8 squared_distances(const PackedTriangles8& packed, const float (&point)[3])
{
    const float from_origin[3] = {point[0] - packed.origin[0], point[1] - packed.origin[1],
                                  point[2] - packed.origin[2]};
    const Bounds8 squared = squared_distances(unpack_at_origin(packed), from_origin);
    // The corners, and with them the triangle, lie within the packing's error e: (d ± e)² is within 2 d e + e² of d².
    const float error = packing_error(packed);
    const Float8 change = cwise_sqrt(squared.upper) * (2 * error) + error * error;
    return {squared.lower - change, squared.upper + change};
}

/// A node still to be visited; at level -1, a leaf.
struct StackEntry {
    float distance; ///< lower bound to what the node holds, in the measure of the search
    std::int32_t level;
    std::uint32_t index;
};

/// Stack of a depth-first search that visits the nearest child of a node first.
class NodeStack {
  public:
    FETTLE_INLINE bool any() const { return size_ > 0; }
    FETTLE_INLINE void push(const StackEntry& node) { entries_[size_++] = node; }
    FETTLE_INLINE const StackEntry& pop() { return entries_[--size_]; }

    /// Pushes children of a node, sorted so that the nearest is popped first.
    /// @param lanes  children to push, a bit each   @param level  of the children   @param node  index of their parent
    FETTLE_INLINE void push(unsigned lanes, const Float8& distances, std::int32_t level, std::uint32_t node)
    {
        const std::size_t first = size_;
        for (LaneIterator left{lanes}; left.any(); left.next()) {
            const float distance = distances[left.first()];
            std::size_t position = size_++;
            for (; position > first && entries_[position - 1].distance < distance; --position)
                entries_[position] = entries_[position - 1];
            entries_[position].distance = distance;
            entries_[position].level = level;
            entries_[position].index = 8 * node + left.first();
        }
    }

  private:
    std::array<StackEntry, kMaxStackSize> entries_;
    std::size_t size_ = 0;
};

} // namespace fettle::mesh
