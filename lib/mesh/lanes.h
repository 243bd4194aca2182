#pragma once

// Vectors of eight floats, one AVX register each. Only for code that is inlined into functions with clones
// (core/simd.h).

#include "core/simd.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fettle::mesh {

/// Eight floats without alignment requirements. A comparison returns a Mask8: all bits of a lane are set where it
/// holds, none where an operand is NaN.
using Float8 = float __attribute__((vector_size(32), aligned(4)));
using Mask8 = std::int32_t __attribute__((vector_size(32), aligned(4)));

/// Unit roundoff of float: the largest relative error of one rounding.
inline constexpr double kFloatRoundoff = std::numeric_limits<float>::epsilon() / 2;

FETTLE_INLINE Float8 cwise_max(Float8 a, Float8 b) { return a > b ? a : b; }
FETTLE_INLINE Float8 cwise_min(Float8 a, Float8 b) { return a < b ? a : b; }
FETTLE_INLINE Float8 broadcast(float value) { return Float8{} + value; }

/// Square roots of all lanes. GCC makes one instruction of the loop under -fno-math-errno (Makefile).
FETTLE_INLINE Float8 cwise_sqrt(Float8 a)
{
    for (int k = 0; k < 8; ++k) a[k] = std::sqrt(a[k]);
    return a;
}

/// Sum of the lanes, always added in the same order.
FETTLE_INLINE float sum_lanes(Float8 a) { return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7])); }
FETTLE_INLINE float min_lane(Float8 a)
{
    a = cwise_min(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
    a = cwise_min(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
    return a[0] < a[1] ? a[0] : a[1];
}
FETTLE_INLINE float max_lane(Float8 a) { return -min_lane(-a); }

/// Eight points or vectors, one coordinate of all of them to a register.
struct Point8 {
    Float8 x, y, z;
};
FETTLE_INLINE Point8 broadcast(const float* point)
{
    return {broadcast(point[0]), broadcast(point[1]), broadcast(point[2])};
}
FETTLE_INLINE Point8 operator+(const Point8& a, const Point8& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
FETTLE_INLINE Point8 operator-(const Point8& a, const Point8& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
FETTLE_INLINE Float8 dot(const Point8& a, const Point8& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FETTLE_INLINE Point8 cross(const Point8& a, const Point8& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Bit k is set where lane k of the mask is.
FETTLE_INLINE unsigned lane_bits(Mask8 mask)
{
    // Pairs of lanes are read as 64-bit words, so that the even lanes are in the lower halves.
    using Words = std::uint64_t __attribute__((vector_size(32)));
    const Mask8 bits = mask & Mask8{1, 2, 4, 8, 16, 32, 64, 128};
    const Words words = std::bit_cast<Words>(bits);
    const std::uint64_t word = (words[0] | words[2]) | (words[1] | words[3]);
    return static_cast<unsigned>(word | word >> 32);
}

/// Iterates over the lanes set in lane_bits(), from the lowest.
struct LaneIterator {
    unsigned bits;

    FETTLE_INLINE bool any() const { return bits != 0; }
    FETTLE_INLINE unsigned first() const { return static_cast<unsigned>(std::countr_zero(bits)); }
    FETTLE_INLINE void next() { bits &= bits - 1; }
};

} // namespace fettle::mesh
