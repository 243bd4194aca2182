#include "gantry/force_loop.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Complex = std::complex<double>;

/// The integral acts four times as slowly as the proportional part, so that it costs 14° of phase at most.
constexpr double kIntegral = 0.25;
/// The nut follows what it sees of the surface's speed by this share at once; more is the transducer's noise.
constexpr double kDerivative = 0.3;
/// Of the drive's acceleration; the rest is for what the surface does meanwhile.
constexpr double kBraking = 0.5;
constexpr double kSlowest = 5, kFastest = 1000, kStep = 1.04; // 1/s

} // namespace

ForceGains force_gains(double kp) { return {kp, kIntegral * kp * kp, kDerivative}; }

Margins force_margins(const ForceGains& gains, const Drive& drive, const ServoGains& servo, const Oscillator& load,
                      double period)
{
    const ExactStep step(load, period);
    return margins([&](Complex z) {
        // Place, speed and acceleration that the drive is told, per speed W at the end of the period.
        const Complex v = 1.0 / z, a = (1.0 - v) / period, p = period * (1.0 + v) / (2.0 * (z - 1.0));
        const double *row_p = step.position_row(), *row_v = step.velocity_row();
        const Complex det = (z - row_p[0]) * (z - row_v[1]) - row_p[1] * row_v[0];
        const Complex plant = drive.gain * ((z - row_v[1]) * row_p[2] + row_p[1] * row_v[2]) / det;
        const Complex pid = servo.kp + servo.ki * period * z / (z - 1.0) + servo.kd / period * (z - 1.0) / z;
        const Complex nut = plant / (1.0 + plant * pid) * (pid * p + servo.kv * (v + a * period / 2.0) + servo.ka * a);
        const Complex force = gains.kp + gains.ki * period * z / (z - 1.0) + gains.kd / period * (z - 1.0) / z;
        return force * nut;
    });
}

ForceGains tune_force(const Drive& drive, double k, double b, double period)
{
    const ServoGains servo = tune(drive, k, b, period);
    const Oscillator free{drive.mass, drive.damping, 0}, sprung{drive.mass, drive.damping + b, k};
    ForceGains best;
    for (double kp = kSlowest; kp < kFastest; kp *= kStep) {
        const ForceGains gains = force_gains(kp);
        if (force_margins(gains, drive, servo, free, period).sensitivity > kMostSensitivity ||
            force_margins(gains, drive, servo, sprung, period).sensitivity > kMostSensitivity)
            break;
        best = gains;
    }
    if (best.kp == 0)
        throw InputError("gantry", "no controller holds the force with its margins: the Z drive is too slow");
    return best;
}

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
