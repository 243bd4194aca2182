#include "gantry/force_tuning.h"

#include "core/error.h"
#include "gantry/force_loop.h"

namespace fettle::gantry {
namespace {

using Complex = std::complex<double>;

/// Range, 1/s, and factor of the search for K_p, from slow to fast; 4 % are negligible.
constexpr double kMinKp = 5, kMaxKp = 1000, kKpFactor = 1.04;

} // namespace

LoopResponse force_response(const Drive& drive, const ServoGains& servo, const Oscillator& load, double period)
{
    const ExactStep step(load, period);
    const auto nut = [&](Complex z) {
        // Position, speed and acceleration of the drive's reference, per speed W at the end of the period.
        const Complex v = 1.0 / z, a = (1.0 - v) / period, p = period * (1.0 + v) / (2.0 * (z - 1.0));
        const Complex plant = drive_response(drive.gain, step, z), pid = response(servo, period, z);
        return plant / (1.0 + plant * pid) * (pid * p + servo.kv * (v + a * period / 2.0) + servo.ka * a);
    };
    return {nut, period, kMarginFrequencies};
}

Pid tune_force(const Drive& drive, double k, double b, double period)
{
    const ServoGains servo = tune_servo(drive, k, b, period);
    const LoopResponse free = force_response(drive, servo, {drive.mass, drive.damping, 0}, period);
    const LoopResponse sprung = force_response(drive, servo, {drive.mass, drive.damping + b, k}, period);
    Pid best;
    for (double kp = kMinKp; kp < kMaxKp; kp *= kKpFactor) {
        const Pid gains = force_gains(kp);
        if (free.sensitivity_peak(gains) > kMaxSensitivity || sprung.sensitivity_peak(gains) > kMaxSensitivity) break;
        best = gains;
    }
    if (best.kp == 0)
        throw core::InputError("gantry",
                               "no force controller has the stability margins: the Z drive is too slow, or its "
                               "sampling period is too long");
    return best;
}

} // namespace fettle::gantry
