#include "removal/preston.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::removal {
namespace {

/// Newton's method on a piecewise linear function ends exactly, up to a few roundings relative to the heights.
constexpr double kRelativeRounding = 32 * std::numeric_limits<double>::epsilon();
/// Each step either ends or excludes cells for good, so a few suffice. The bound guards against NaN.
constexpr int kMaxNewtonSteps = 200;

} // namespace

Balance press(const WheelInStock& wheel, const Spring& spring, double z_stop, double c_dt, double guess)
{
    if (!(wheel.touch() > z_stop)) return {z_stop, 0, 0, 0};

    // g(z) = lift(z) − c dt F(z) is convex and falls: from its left Newton's method climbs to the root without
    // passing it, from its right the first step lands on the left or at the stop.
    const double rounding = kRelativeRounding * (std::abs(z_stop) + std::abs(wheel.touch()) + 1);
    double z = std::clamp(guess, z_stop, wheel.touch());
    for (int step = 0;; ++step) {
        const WheelInStock::Overlap overlap = wheel.overlap(z);
        const double g = overlap.lift - c_dt * spring.force(z - z_stop);
        const double push = overlap.push / c_dt;
        if (z <= z_stop && g <= 0) return {z_stop, overlap.lift / c_dt, overlap.volume, push};
        const double next = std::max(z + g / (overlap.area + c_dt * spring.stiffness), z_stop);
        if (std::abs(next - z) <= rounding || step == kMaxNewtonSteps)
            return {z, spring.force(z - z_stop), overlap.volume, push};
        z = next;
    }
}

} // namespace fettle::removal
