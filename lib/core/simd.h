#pragma once

#include <cmath>
#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

// GCC warns that passing vectors depends on the ABI; they are only passed to inlined functions.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Compiles a function twice, for any x86-64 and for AVX2; the loader chooses one. With -ffp-contract=off and sums in a
/// fixed order of lanes both give the same results, bit for bit. With the thread sanitizer there is one: the loader
/// would choose before the sanitizer has begun, and crash in it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define FETTLE_CLONES __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define FETTLE_CLONES
#endif

/// For functions called by a function with clones: they must be inlined, because the ABI for vectors passed by value
/// differs between the clones.
#define FETTLE_INLINE [[gnu::always_inline]] inline

namespace fettle::core {

/// Four doubles without alignment requirements. A comparison returns a Mask4: all bits of a lane are set where it
/// holds, none where an operand is NaN. These are typedefs because clang ignores the alignment in alias declarations.
typedef double Double4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef std::int64_t Mask4 __attribute__((vector_size(32), aligned(8), may_alias));

// As for the Float8 of mesh/lanes.h.
FETTLE_INLINE Double4 broadcast(double value) { return Double4{} + value; }
FETTLE_INLINE Double4 cwise_max(const Double4& a, const Double4& b) { return a > b ? a : b; }
FETTLE_INLINE Double4 cwise_min(const Double4& a, const Double4& b) { return a < b ? a : b; }
FETTLE_INLINE Double4 cwise_sqrt(const Double4& a)
{
#ifdef __SSE2__
    const __m128d low = _mm_sqrt_pd(__m128d{a[0], a[1]}), high = _mm_sqrt_pd(__m128d{a[2], a[3]});
    return Double4{low[0], low[1], high[0], high[1]};
#else
    return Double4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}

} // namespace fettle::core
