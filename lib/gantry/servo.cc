#include "gantry/servo.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace fettle {
namespace {

using Complex = std::complex<double>;

constexpr int kFrequencies = 200; // of the response while gains are looked for
/// The search for ω: from slow to fast, in steps that matter to nobody.
constexpr double kSlowest = 5, kFastest = 2000, kStep = 1.04; // rad/s
constexpr double kQuiet = 0.1;                                // of the voltage, by one count

ServoGains place_poles(const Drive& drive, double omega)
{
    // m s³ + (d + g K_d) s² + g K_p s + g K_i = m (s + ω)² (s + p): p = ω, or, where the drive's own brake is more than
    // that takes, what it gives without K_d.
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

ServoGains tune(const Drive& drive, double k, double b, double period)
{
    const LoopResponse free = servo_response(drive, {drive.mass, drive.damping, 0}, period, kFrequencies);
    const LoopResponse sprung = servo_response(drive, {drive.mass, drive.damping + b, k}, period, kFrequencies);
    const auto good = [&](const ServoGains& gains) {
        const double kick = (gains.kp + gains.kd / period) * drive.encoder;
        return kick <= kQuiet * std::min(drive.voltage, drive.current) &&
               free.sensitivity_peak(gains) <= kMostSensitivity && sprung.sensitivity_peak(gains) <= kMostSensitivity;
    };
    ServoGains best;
    for (double omega = kSlowest; omega < kFastest; omega *= kStep) {
        const ServoGains gains = place_poles(drive, omega);
        if (!good(gains)) break;
        best = gains;
    }
    if (best.bandwidth == 0)
        throw InputError("gantry",
                         "no controller holds a drive's margins: its encoder is too coarse, or it is too weak "
                         "for the head's spring");
    return best;
}

ServoAxis::ServoAxis(const Drive& drive, double k, double b, double period, double at)
    : drive_(drive), k_(k), b_(b), period_(period), gains_(tune(drive, k, b, period)),
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
    // In the middle of the period the drive runs as fast as the feed-forward has to.
    const double ahead = gains_.kv * (reference.v + reference.a * period_ / 2) + gains_.ka * reference.a + gains_.v0;
    const double wanted = gains_.kp * error + gains_.kd * (error - last_error_) / period_ + ahead;
    last_error_ = error;
    const double emf = drive_.emf * motion_.v;
    const double most = std::min(drive_.voltage, emf + drive_.current);
    const double least = std::max(-drive_.voltage, emf - drive_.current);
    // An amplifier at its limit winds nothing up.
    const double integral = integral_ + gains_.ki * error * period_;
    const double whole = wanted + integral;
    if ((whole <= most || integral < integral_) && (whole >= least || integral > integral_)) integral_ = integral;
    return std::clamp(wanted + integral_, least, most);
}

void ServoAxis::measure() { measured_ = std::round(motion_.p / drive_.encoder) * drive_.encoder; }

} // namespace fettle
