#pragma once

// The lower side of a cutter over four places at a time. Only for sweep and drop_cutter.

#include "core/simd.h"
#include "machining/cutter.h"

#include <cmath>
#include <cstddef>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

// Vectors go nowhere but into functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace fettle {

inline constexpr std::ptrdiff_t kLanes = 4; // of Double4
/// A cell on the cutter's rim, but for rounding, is under it; mm.
inline constexpr double kOnRim = 1e-9;
inline constexpr double kBeyond = std::numeric_limits<double>::infinity();

FETTLE_INLINE Double4 all(double value) { return Double4{} + value; }
FETTLE_INLINE Double4 larger(const Double4& a, const Double4& b) { return a > b ? a : b; }
FETTLE_INLINE Double4 smaller(const Double4& a, const Double4& b) { return a < b ? a : b; }
FETTLE_INLINE Double4 root(const Double4& a)
{
#ifdef __SSE2__
    const __m128d low = _mm_sqrt_pd(__m128d{a[0], a[1]}), high = _mm_sqrt_pd(__m128d{a[2], a[3]});
    return Double4{low[0], low[1], high[0], high[1]};
#else
    return Double4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}
// The lower sides of the cutters: lead (cutter.h) and rise of four cells at once. Beyond the rim the rise is NaN or
// infinite.

struct BallSide {
    double r, factor;
    BallSide(const Cutter& c, double slope) : r(c.corner), factor(-slope / std::sqrt(1 + slope * slope)) {}
    FETTLE_INLINE Double4 lead(const Double4& across) const
    {
        return factor * root(larger(all(r * r) - across * across, Double4{}));
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const { return r - root(r * r - square); }
};

struct FlatSide {
    double R, rim, sign;
    FlatSide(const Cutter& c, double slope)
        : R(c.radius), rim((R + kOnRim) * (R + kOnRim)), sign(slope > 0 ? -1 : (slope < 0 ? 1 : 0))
    {
    }
    FETTLE_INLINE Double4 lead(const Double4& across) const
    {
        return sign * root(larger(all(R * R) - across * across, Double4{}));
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const { return square <= rim ? Double4{} : all(kBeyond); }
};

/// A ball swept along a circle. Of its points, at c sin α from the way, the one that counts is where both are equally
/// steep: c sin α + r sin β = across, tan β = κ tan α, with κ = slope/√(1 + slope²). In X = sin α the left side is
/// p X + q X/√(m + n X²) with p = c, q = r κ, m = 1, n = κ² - 1, which bends where α nears a right angle, as sharply as
/// κ is small; in X = sin β it is the same with p = r, q = c, m = κ², n = 1 - κ², which bends where β is small. So
/// before the knee, tan α = 1/√κ, the equation is solved for α, beyond it for β. The one is convex, the other concave:
/// Newton's method comes monotonously to the root, down to α, up to β.
struct BullSide {
    double r, c, up, sign, kappa, less, knee_alpha, knee_beta, knee;

    BullSide(const Cutter& cutter, double slope)
        : r(cutter.corner), c(cutter.flat), up(slope), sign(slope > 0 ? -1 : 1),
          kappa(std::abs(slope) / std::sqrt(1 + slope * slope)), less((1 - kappa) * (1 + kappa)),
          knee_alpha(std::sqrt(1 / (1 + kappa))), knee_beta(std::sqrt(kappa / (1 + kappa))),
          knee(c * knee_alpha + r * knee_beta)
    {
    }
    FETTLE_INLINE Double4 lead(const Double4& side) const
    {
        constexpr int kMost = 100;       // never met: steps at least double the digits beside the knee
        constexpr double kEnough = 1e-9; // the next step would be its square; so is the height's error
        const Double4 across = smaller(larger(side, -side), all(c + r));
        const Mask4 beyond = across > knee;
        const Double4 p = beyond ? all(r) : all(c), q = beyond ? all(c) : all(r * kappa);
        const Double4 m = beyond ? all(kappa * kappa) : all(1.0), n = beyond ? all(less) : all(-less);
        // from beneath β, and from above α: q X/√(m + n X²) is no more than q/√n, and no less than q X
        Double4 X = beyond ? larger(all(knee_beta), (across - c / std::sqrt(less)) / r)
                           : smaller(all(knee_alpha), across / (c + r * kappa));
        for (int i = 0; i < kMost; ++i) {
            const Double4 inverse = 1 / root(m + n * X * X), slope = q * inverse;
            const Double4 step = (p * X + slope * X - across) / (p + slope * m * inverse * inverse);
            X = smaller(larger(X - step, Double4{}), all(1.0));
            const Mask4 far = (step > kEnough) | (step < -kEnough);
            if (((far[0] | far[1]) | (far[2] | far[3])) == 0) break;
        }
        const Double4 other = 1 - X * X; // cos² of the angle solved for
        const Double4 cosine = beyond ? kappa * root(other / (kappa * kappa + less * X * X)) : root(other); // of α
        const Double4 beside = beyond ? r * X : across - c * X;
        return sign * (c * cosine + kappa * root(larger(all(r * r) - beside * beside, Double4{})));
    }
    /// along + lead, within a way: most cells beside a short way are nearest to one of its ends, which needs no search.
    FETTLE_INLINE Double4 axis(const Double4& along, const Double4& across, double length) const
    {
        const Mask4 before = rises(along, across) > 0.0, after = rises(along - length, across) < 0.0;
        const Mask4 within = ~(before | after);
        const Double4 end = before ? Double4{} : all(length);
        if (((within[0] | within[1]) | (within[2] | within[3])) == 0) return end;
        return within ? smaller(larger(along + lead(across), Double4{}), all(length)) : end;
    }
    /// Has the sign of how the height over a cell changes as the axis moves on; the cell is `ahead` of it.
    FETTLE_INLINE Double4 rises(const Double4& ahead, const Double4& across) const
    {
        const Double4 distance = root(ahead * ahead + across * across), from_disc = larger(distance - c, Double4{});
        return up * distance * root(larger(r * r - from_disc * from_disc, Double4{})) - from_disc * ahead;
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const
    {
        const Double4 from_disc = larger(root(square) - c, Double4{});
        return r - root((r - from_disc) * (r + from_disc));
    }
};

struct TaperSide {
    double R, r, rim, cone_from, cone_rise, cone_slope, sign, ball, cone;
    TaperSide(const Cutter& c, double slope)
        : R(c.radius), r(c.corner), rim((R + kOnRim) * (R + kOnRim)), cone_from(c.cone_from),
          cone_rise(fettle::rise(c, c.cone_from)), cone_slope(c.cone_slope), sign(slope > 0 ? -1 : 1),
          ball(std::abs(slope) / std::sqrt(1 + slope * slope))
    {
        const double up = std::abs(slope); // the cone's own way up is no less steep: its rim counts
        cone = up < cone_slope ? up / std::sqrt((cone_slope - up) * (cone_slope + up)) : kBeyond;
    }
    FETTLE_INLINE Double4 lead(const Double4& side) const
    {
        const Double4 square = side * side, on_ball = ball * root(larger(r * r - square, Double4{}));
        const Double4 on_rim = root(larger(R * R - square, Double4{}));
        const Double4 on_cone = smaller(cone * larger(side, -side), on_rim); // of NaN, too, the rim
        const Mask4 is_ball = on_ball * on_ball + square <= cone_from * cone_from;
        return sign * (is_ball ? on_ball : on_cone);
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const
    {
        const Double4 on_ball = r - root(larger(r * r - square, Double4{}));
        const Double4 on_cone = cone_rise + cone_slope * (root(square) - cone_from);
        const Double4 within = square > cone_from * cone_from ? on_cone : on_ball;
        return square <= rim ? within : all(kBeyond);
    }
};

/// Calls work.template operator()<Side>() with the cutter's own.
template <typename Work>
auto with_side(const Cutter& cutter, const Work& work)
{
    if (cutter.cone_from < cutter.radius) return work.template operator()<TaperSide>();
    if (cutter.corner == 0) return work.template operator()<FlatSide>();
    if (cutter.flat == 0) return work.template operator()<BallSide>();
    return work.template operator()<BullSide>();
}

} // namespace fettle
