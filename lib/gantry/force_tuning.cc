#include "gantry/force_tuning.h"

#include "core/error.h"
#include "gantry/force_loop.h"

namespace fettle {
namespace {

using Complex = std::complex<double>;

/// The search for K_p: from slow to fast, in steps that matter to nobody.
constexpr double kSlowest = 5, kFastest = 1000, kStep = 1.04; // 1/s

} // namespace

LoopResponse force_response(const Drive& drive, const ServoGains& servo, const Oscillator& load, double period)
{
    const ExactStep step(load, period);
    const auto nut = [&](Complex z) {
        // Place, speed and acceleration that the drive is told, per speed W at the end of the period.
        const Complex v = 1.0 / z, a = (1.0 - v) / period, p = period * (1.0 + v) / (2.0 * (z - 1.0));
        const Complex plant = drive_response(drive.gain, step, z), pid = response(servo, period, z);
        return plant / (1.0 + plant * pid) * (pid * p + servo.kv * (v + a * period / 2.0) + servo.ka * a);
    };
    return {nut, period, kFineFrequencies};
}

Pid tune_force(const Drive& drive, double k, double b, double period)
{
    const ServoGains servo = tune(drive, k, b, period);
    const LoopResponse free = force_response(drive, servo, {drive.mass, drive.damping, 0}, period);
    const LoopResponse sprung = force_response(drive, servo, {drive.mass, drive.damping + b, k}, period);
    Pid best;
    for (double kp = kSlowest; kp < kFastest; kp *= kStep) {
        const Pid gains = force_gains(kp);
        if (free.sensitivity_peak(gains) > kMostSensitivity || sprung.sensitivity_peak(gains) > kMostSensitivity) break;
        best = gains;
    }
    if (best.kp == 0)
        throw InputError("gantry", "no controller holds the force with its margins: the Z drive is too slow, or its "
                                   "controller looks too rarely");
    return best;
}

} // namespace fettle
