#include "gantry/force_loop.h"

#include <algorithm>
#include <cmath>

namespace fettle::gantry {
namespace {

/// K_i relative to K_p²: the integral is four times slower than the proportional part, and costs 14° of phase at most.
constexpr double kIntegralRatio = 0.25;
/// K_d, the share of the surface's speed that the nut follows at once; more would amplify the transducer's noise.
constexpr double kDerivativeGain = 0.3;
/// Share of the drive's acceleration that is used for braking; the rest is for changes of the surface meanwhile.
constexpr double kBrakingShare = 0.5;

} // namespace

Pid force_gains(double kp) { return {kp, kIntegralRatio * kp * kp, kDerivativeGain}; }

double ForceLoop::step(double desired, double measured, double velocity, double max_down)
{
    const double error = desired - measured;
    const double change = has_last_error_ ? error - last_error_ : 0;
    last_error_ = error;
    has_last_error_ = true;
    const double max_change = acceleration_ * period_;
    const double integral = integral_ + gains_.ki * error * period_;
    // The speed is limited so that the drive can stop at e = 0: a loop that runs into its limits oscillates.
    const double max_speed = std::sqrt(2 * kBrakingShare * acceleration_ * std::abs(error));
    const double proportional = std::clamp(gains_.kp * error, -max_speed, max_speed);
    const double requested = -(proportional + integral + gains_.kd * change / period_);
    const double next =
        std::clamp(requested, std::max(velocity - max_change, -speed_), std::min(velocity + max_change, speed_));
    // Anti-windup: no integration while the drive is at a limit.
    const double bounded = std::max(next, -max_down);
    const bool free = bounded == requested && proportional == gains_.kp * error;
    if (free || std::abs(integral) < std::abs(integral_)) integral_ = integral;
    return bounded;
}

} // namespace fettle::gantry
