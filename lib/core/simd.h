#pragma once

#include <cstdint>

/// Compiles a function twice, for any x86-64 and for one with AVX2; the loader chooses. With -ffp-contract=off and sums
/// in fixed lanes both give the same digits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define FETTLE_CLONES __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define FETTLE_CLONES
#endif

/// For what a function with clones calls: in vectors that are passed by value the clones do not agree with the rest.
#define FETTLE_INLINE [[gnu::always_inline]] inline

namespace fettle {

/// Four lanes, anywhere in memory. A comparison gives Mask4: all bits set where it holds, never for NaN.
/// Old-fashioned typedefs: in others clang does not heed the alignment.
typedef double Double4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef std::int64_t Mask4 __attribute__((vector_size(32), aligned(8), may_alias));

} // namespace fettle
