#include "gantry/force_loop.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// The integral acts four times as slowly as the proportional part, so that it costs 14° of phase at most.
constexpr double kIntegral = 0.25;
/// The nut follows what it sees of the surface's speed by this share at once; more is the transducer's noise.
constexpr double kDerivative = 0.3;
/// Of the drive's acceleration; the rest is for what the surface does meanwhile.
constexpr double kBraking = 0.5;

} // namespace

Pid force_gains(double kp) { return {kp, kIntegral * kp * kp, kDerivative}; }

double ForceLoop::step(double wanted, double seen, double velocity, double down)
{
    const double error = wanted - seen;
    const double change = begun_ ? error - last_ : 0;
    last_ = error;
    begun_ = true;
    const double most = acceleration_ * period_;
    const double integral = integral_ + gains_.ki * error * period_;
    // No faster towards it than the drive can stop there: a loop that runs into its limits swings.
    const double stop = std::sqrt(2 * kBraking * acceleration_ * std::abs(error));
    const double towards = std::clamp(gains_.kp * error, -stop, stop);
    const double asked = -(towards + integral + gains_.kd * change / period_);
    const double next = std::clamp(asked, std::max(velocity - most, -speed_), std::min(velocity + most, speed_));
    // A drive at its limit winds nothing up.
    const double bounded = std::max(next, -down);
    const bool free = bounded == asked && towards == gains_.kp * error;
    if (free || std::abs(integral) < std::abs(integral_)) integral_ = integral;
    return bounded;
}

} // namespace fettle
