#pragma once

// The lower side of a cutter at four points at a time. Only for sweep and drop_cutter.

#include "core/constants.h"
#include "core/simd.h"
#include "machining/cutter.h"

#include <cmath>
#include <cstddef>

namespace fettle::machining {

using core::Double4, core::Mask4, core::broadcast, core::cwise_max, core::cwise_min, core::cwise_sqrt;

inline constexpr std::ptrdiff_t kLanes = 4; // of Double4
/// A cell within this distance outside the cutter's rim counts as under it: rounding, mm.
inline constexpr double kRimTolerance = 1e-9;

// Lead (cutter.h) and rise of each kind of cutter over four cells at once. Outside the rim the rise is NaN or infinite.

struct BallSide {
    double r, factor;
    BallSide(const Cutter& c, double slope) : r(c.corner), factor(-slope / std::sqrt(1 + slope * slope)) {}
    FETTLE_INLINE Double4 lead(const Double4& across) const
    {
        return factor * cwise_sqrt(cwise_max(broadcast(r * r) - across * across, Double4{}));
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const { return r - cwise_sqrt(r * r - square); }
};

struct FlatSide {
    double R, rim, sign;
    FlatSide(const Cutter& c, double slope)
        : R(c.radius), rim((R + kRimTolerance) * (R + kRimTolerance)), sign(slope > 0 ? -1 : (slope < 0 ? 1 : 0))
    {
    }
    FETTLE_INLINE Double4 lead(const Double4& across) const
    {
        return sign * cwise_sqrt(cwise_max(broadcast(R * R) - across * across, Double4{}));
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const
    {
        return square <= rim ? Double4{} : broadcast(core::kInfinity);
    }
};

/// A torus: a ball swept along a circle of radius c. The contact is at the angle α on the circle, c sin α from the line
/// of travel, where ball and circle are equally steep: c sin α + r sin β = across, tan β = κ tan α, with
/// κ = slope/√(1 + slope²). In X = sin α the left side is p X + q X/√(m + n X²) with p = c, q = r κ, m = 1, n = κ² - 1,
/// which bends where α nears a right angle, the more sharply the smaller κ; in X = sin β it has the same form with
/// p = r, q = c, m = κ², n = 1 - κ², and bends where β is small. So the equation is solved for α below the knee,
/// tan α = 1/√κ, and for β above it. The first is convex, the second concave: Newton's method converges monotonically,
/// from above to α, from below to β.
struct BullSide {
    double r, c, slope, sign, kappa, one_minus_kappa2, knee_alpha, knee_beta, knee;

    BullSide(const Cutter& cutter, double climb)
        : r(cutter.corner), c(cutter.flat), slope(climb), sign(slope > 0 ? -1 : 1),
          kappa(std::abs(slope) / std::sqrt(1 + slope * slope)), one_minus_kappa2((1 - kappa) * (1 + kappa)),
          knee_alpha(std::sqrt(1 / (1 + kappa))), knee_beta(std::sqrt(kappa / (1 + kappa))),
          knee(c * knee_alpha + r * knee_beta)
    {
    }
    FETTLE_INLINE Double4 lead(const Double4& side) const
    {
        constexpr int kMaxIterations = 100;     // never reached: Newton's method converges quadratically off the knee
        constexpr double kStepTolerance = 1e-9; // the next step, and the error of the height, would be its square
        const Double4 across = cwise_min(cwise_max(side, -side), broadcast(c + r));
        const Mask4 for_beta = across > knee;
        const Double4 p = for_beta ? broadcast(r) : broadcast(c), q = for_beta ? broadcast(c) : broadcast(r * kappa);
        const Double4 m = for_beta ? broadcast(kappa * kappa) : broadcast(1.0);
        const Double4 n = for_beta ? broadcast(one_minus_kappa2) : broadcast(-one_minus_kappa2);
        // Start below sin β and above sin α: q X ≤ q X/√(m + n X²) ≤ q/√n.
        Double4 X = for_beta ? cwise_max(broadcast(knee_beta), (across - c / std::sqrt(one_minus_kappa2)) / r)
                             : cwise_min(broadcast(knee_alpha), across / (c + r * kappa));
        for (int i = 0; i < kMaxIterations; ++i) {
            const Double4 inverse = 1 / cwise_sqrt(m + n * X * X), factor = q * inverse;
            const Double4 step = (p * X + factor * X - across) / (p + factor * m * inverse * inverse);
            X = cwise_min(cwise_max(X - step, Double4{}), broadcast(1.0));
            const Mask4 moving = (step > kStepTolerance) | (step < -kStepTolerance);
            if (((moving[0] | moving[1]) | (moving[2] | moving[3])) == 0) break;
        }
        const Double4 cos2 = 1 - X * X; // of the angle solved for
        const Double4 cos_alpha =
            for_beta ? kappa * cwise_sqrt(cos2 / (kappa * kappa + one_minus_kappa2 * X * X)) : cwise_sqrt(cos2);
        const Double4 r_sin_beta = for_beta ? r * X : across - c * X;
        return sign *
               (c * cos_alpha + kappa * cwise_sqrt(cwise_max(broadcast(r * r) - r_sin_beta * r_sin_beta, Double4{})));
    }
    /// along + lead, clamped to the move: near a short move most cells are nearest to an end, which needs no iteration.
    FETTLE_INLINE Double4 clamped_axis(const Double4& along, const Double4& across, double length) const
    {
        const Mask4 before = height_derivative_sign(along, across) > 0.0;
        const Mask4 after = height_derivative_sign(along - length, across) < 0.0;
        const Mask4 within = ~(before | after);
        const Double4 end = before ? Double4{} : broadcast(length);
        if (((within[0] | within[1]) | (within[2] | within[3])) == 0) return end;
        return within ? cwise_min(cwise_max(along + lead(across), Double4{}), broadcast(length)) : end;
    }
    /// Has the sign of the derivative of the height over a cell by the position of the axis; the cell is `ahead` of it.
    FETTLE_INLINE Double4 height_derivative_sign(const Double4& ahead, const Double4& across) const
    {
        const Double4 distance = cwise_sqrt(ahead * ahead + across * across),
                      from_disc = cwise_max(distance - c, Double4{});
        return slope * distance * cwise_sqrt(cwise_max(r * r - from_disc * from_disc, Double4{})) - from_disc * ahead;
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const
    {
        const Double4 from_disc = cwise_max(cwise_sqrt(square) - c, Double4{});
        return r - cwise_sqrt((r - from_disc) * (r + from_disc));
    }
};

struct TaperSide {
    double R, r, rim, cone_from, cone_rise, cone_slope, sign, ball, cone; ///< ball, cone: factors of the lead
    TaperSide(const Cutter& c, double slope)
        : R(c.radius), r(c.corner), rim((R + kRimTolerance) * (R + kRimTolerance)), cone_from(c.cone_from),
          cone_rise(machining::rise(c, c.cone_from)), cone_slope(c.cone_slope), sign(slope > 0 ? -1 : 1),
          ball(std::abs(slope) / std::sqrt(1 + slope * slope))
    {
        const double climb = std::abs(slope); // if the cone is not steeper than the climb, its rim is the contact
        cone = climb < cone_slope ? climb / std::sqrt((cone_slope - climb) * (cone_slope + climb)) : core::kInfinity;
    }
    FETTLE_INLINE Double4 lead(const Double4& side) const
    {
        const Double4 square = side * side, on_ball = ball * cwise_sqrt(cwise_max(r * r - square, Double4{}));
        const Double4 on_rim = cwise_sqrt(cwise_max(R * R - square, Double4{}));
        const Double4 on_cone = cwise_min(cone * cwise_max(side, -side), on_rim); // NaN gives the rim
        const Mask4 is_ball = on_ball * on_ball + square <= cone_from * cone_from;
        return sign * (is_ball ? on_ball : on_cone);
    }
    FETTLE_INLINE Double4 rise(const Double4& square) const
    {
        const Double4 on_ball = r - cwise_sqrt(cwise_max(r * r - square, Double4{}));
        const Double4 on_cone = cone_rise + cone_slope * (cwise_sqrt(square) - cone_from);
        const Double4 within = square > cone_from * cone_from ? on_cone : on_ball;
        return square <= rim ? within : broadcast(core::kInfinity);
    }
};

/// Calls work.template operator()<Side>() with the type of the cutter's lower side.
template <typename Work>
auto with_side(const Cutter& cutter, const Work& work)
{
    if (cutter.cone_from < cutter.radius) return work.template operator()<TaperSide>();
    if (cutter.corner == 0) return work.template operator()<FlatSide>();
    if (cutter.flat == 0) return work.template operator()<BallSide>();
    return work.template operator()<BullSide>();
}

} // namespace fettle::machining
