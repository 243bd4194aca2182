#pragma once

// Eight numbers at a time. Only for code that is inlined into functions with clones (core/simd.h).

#include "core/simd.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

// Vectors go nowhere but into functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace fettle {

/// Eight numbers side by side, anywhere in memory. A comparison gives Mask8: all bits set where it holds, never for
/// NaN.
using Float8 = float __attribute__((vector_size(32), aligned(4)));
using Mask8 = std::int32_t __attribute__((vector_size(32), aligned(4)));

inline constexpr double kEpsilon = std::numeric_limits<float>::epsilon() / 2; // most of a rounding, relative

FETTLE_INLINE Float8 larger(Float8 a, Float8 b) { return a > b ? a : b; }
FETTLE_INLINE Float8 smaller(Float8 a, Float8 b) { return a < b ? a : b; }
FETTLE_INLINE Float8 all(float value) { return Float8{} + value; }

/// Square roots; compilers find one instruction for it if nobody reads errno (Makefile).
FETTLE_INLINE Float8 root(Float8 a)
{
    for (int k = 0; k < 8; ++k) a[k] = std::sqrt(a[k]);
    return a;
}

/// Of all lanes, always in the same order.
FETTLE_INLINE float sum_of(Float8 a) { return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7])); }
FETTLE_INLINE float least_of(Float8 a)
{
    a = smaller(a, __builtin_shuffle(a, Mask8{4, 5, 6, 7, 0, 1, 2, 3}));
    a = smaller(a, __builtin_shuffle(a, Mask8{2, 3, 0, 1, 6, 7, 4, 5}));
    return a[0] < a[1] ? a[0] : a[1];
}
FETTLE_INLINE float most_of(Float8 a) { return -least_of(-a); }

struct Point8 {
    Float8 x, y, z;
};
FETTLE_INLINE Point8 all(const float* point) { return {all(point[0]), all(point[1]), all(point[2])}; }
FETTLE_INLINE Point8 operator+(const Point8& a, const Point8& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
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

/// Lanes out of lanes_of(), one by one.
struct Lanes {
    unsigned bits;

    FETTLE_INLINE bool any() const { return bits != 0; }
    FETTLE_INLINE unsigned first() const { return static_cast<unsigned>(std::countr_zero(bits)); }
    FETTLE_INLINE void next() { bits &= bits - 1; }
};

} // namespace fettle
