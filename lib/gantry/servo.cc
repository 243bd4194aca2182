#include "gantry/servo.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace fettle::gantry {
namespace {

using Complex = std::complex<double>;

constexpr int kTuningFrequencies = 200; // of a response during the search
/// Range, rad/s, and factor of the search for ω, from slow to fast; 4 % are negligible.
constexpr double kMinOmega = 5, kMaxOmega = 2000, kOmegaFactor = 1.04;
constexpr double kMaxVoltagePerCount = 0.1; // change of the voltage by one encoder count, relative to its limit

ServoGains place_poles(const Drive& drive, double omega)
{
    // m s³ + (d + g K_d) s² + g K_p s + g K_i = m (s + ω)² (s + p): p = ω, or, where the drive's own damping is larger
    // than that, the p that follows from K_d = 0.
    const double m = drive.mass / drive.gain, d = drive.damping / drive.gain;
    const double p = std::max(omega, d / m - 2 * omega);
    ServoGains gains;
    gains.kp = omega * (omega + 2 * p) * m;
    gains.ki = omega * omega * p * m;
    gains.kd = std::max((2 * omega + p) * m - d, 0.0);
    gains.kv = drive.damping / drive.gain;
    gains.ka = m;
    gains.v0 = drive.load / drive.gain;
    gains.bandwidth = omega;
    return gains;
}

} // namespace

Complex drive_response(double drive_gain, const ExactStep& step, Complex z)
{
    const double *p = step.position_row(), *v = step.velocity_row();
    const Complex det = (z - p[0]) * (z - v[1]) - p[1] * v[0];
    return drive_gain * ((z - v[1]) * p[2] + p[1] * v[2]) / det;
}

LoopResponse servo_response(const Drive& drive, const Oscillator& load, double period, int frequencies)
{
    const ExactStep step(load, period);
    return {[&](Complex z) { return drive_response(drive.gain, step, z); }, period, frequencies};
}

ServoGains tune_servo(const Drive& drive, double k, double b, double period)
{
    const LoopResponse free = servo_response(drive, {drive.mass, drive.damping, 0}, period, kTuningFrequencies);
    const LoopResponse sprung = servo_response(drive, {drive.mass, drive.damping + b, k}, period, kTuningFrequencies);
    const auto acceptable = [&](const ServoGains& gains) {
        const double kick = (gains.kp + gains.kd / period) * drive.encoder;
        return kick <= kMaxVoltagePerCount * std::min(drive.voltage, drive.current) &&
               free.sensitivity_peak(gains) <= kMaxSensitivity && sprung.sensitivity_peak(gains) <= kMaxSensitivity;
    };
    ServoGains best;
    for (double omega = kMinOmega; omega < kMaxOmega; omega *= kOmegaFactor) {
        const ServoGains gains = place_poles(drive, omega);
        if (!acceptable(gains)) break;
        best = gains;
    }
    if (best.bandwidth == 0)
        throw core::InputError(
            "gantry",
            "no servo controller has the stability margins: the drive's encoder is too coarse, or it is too weak "
            "for the head's spring");
    return best;
}

ServoAxis::ServoAxis(const Drive& drive, double k, double b, double period, double at)
    : drive_(drive), k_(k), b_(b), period_(period), gains_(tune_servo(drive, k, b, period)),
      free_({drive.mass, drive.damping, 0}, period), sprung_({drive.mass, drive.damping + b, k}, period), motion_{at, 0}
{
    measure();
    voltage_ = gains_.v0;
}

void ServoAxis::step(const Reference& reference, double force)
{
    voltage_ = control(reference);
    motion_ = free_(motion_, drive_.gain * voltage_ - drive_.load + force, 0);
    measure();
}

void ServoAxis::step_with_spring(const Reference& reference, double preload, double end, double rate)
{
    voltage_ = control(reference);
    const double constant = drive_.gain * voltage_ - drive_.load + preload;
    motion_ = sprung_(motion_, constant + k_ * end + b_ * rate, k_ * rate);
    measure();
}

double ServoAxis::control(const Reference& reference)
{
    const double error = reference.p - measured_;
    // The feed-forward uses the speed in the middle of the period.
    const double ahead = gains_.kv * (reference.v + reference.a * period_ / 2) + gains_.ka * reference.a + gains_.v0;
    const double without_integral = gains_.kp * error + gains_.kd * (error - last_error_) / period_ + ahead;
    last_error_ = error;
    const double emf = drive_.emf * motion_.v;
    const double max_voltage = std::min(drive_.voltage, emf + drive_.current);
    const double min_voltage = std::max(-drive_.voltage, emf - drive_.current);
    // Anti-windup: no integration towards the limit of the amplifier.
    const double integral = integral_ + gains_.ki * error * period_;
    const double total = without_integral + integral;
    if ((total <= max_voltage || integral < integral_) && (total >= min_voltage || integral > integral_))
        integral_ = integral;
    return std::clamp(without_integral + integral_, min_voltage, max_voltage);
}

void ServoAxis::measure() { measured_ = std::round(motion_.p / drive_.encoder) * drive_.encoder; }

} // namespace fettle::gantry
