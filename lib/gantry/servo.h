#pragma once

#include "gantry/exact_step.h"
#include "gantry/loop_response.h"
#include "gantry/machine.h"

#include <complex>

namespace fettle::gantry {

/// Reference signal of a servo loop at the beginning of a period; the acceleration is constant over the period. mm,
/// mm/s, mm/s² (of a rotary axis rad).
struct Reference {
    double p = 0, v = 0, a = 0;
};

/// V = K_p e + K_i ∫e + K_d ė + K_v v + K_a a + V_0: PID and feed-forward. Volts, mm and s (of a rotary axis rad).
struct ServoGains : Pid {
    double kv = 0, ka = 0, v0 = 0;
    double bandwidth = 0; ///< ω of the slowest poles, rad/s
};

/// Position per volt, at z, of a drive whose voltage is constant over a period.   @param gain  N per volt
std::complex<double> drive_response(double gain, const ExactStep& step, std::complex<double> z);

/// Number of frequencies that gives a loop's margins to a thousandth.
inline constexpr int kMarginFrequencies = 4000;

/// Response of the loop around a drive, opened at the voltage.
/// @param load  mechanical load of the drive
LoopResponse servo_response(const Drive& drive, const Oscillator& load, double period, int frequencies);

/// Places the poles at −ω (and a third one farther out where the drive brakes itself more), ω as large as two
/// conditions allow: the sensitivity peak of the sampled loop, free and against the spring (k, b), stays within
/// kMaxSensitivity; one count of the encoder moves the voltage by no more than a tenth of the amplifier's limit.
/// Feed-forward is the inverse of the drive.
/// @throws InputError if there is none
ServoGains tune_servo(const Drive& drive, double k, double b, double period);

/// One axis: drive, encoder and controller. Between two samples of the controller its voltage is constant, and the
/// motion is exact.
class ServoAxis {
  public:
    /// @param k, b  spring and damper that may load the drive, N/mm, N s/mm
    ServoAxis(const Drive& drive, double k, double b, double period, double at);

    /// Simulates one period under a constant force (towards +p).
    void step(const Reference& reference, double force);
    /// Simulates one period against the spring and the damper, whose other end is at `end` and moves at the constant
    /// `rate` (Wang 2007, eq. 6-7; there the damper's share of the other end, K b ż_r, is missing on the right).
    void step_with_spring(const Reference& reference, double preload, double end, double rate);

    const Motion& motion() const { return motion_; }
    double measured() const { return measured_; } ///< by the encoder
    double voltage() const { return voltage_; }

  private:
    double control(const Reference& reference);
    void measure();

    Drive drive_;
    double k_, b_, period_;
    ServoGains gains_;
    ExactStep free_, sprung_;
    Motion motion_;
    double measured_, integral_ = 0, last_error_ = 0, voltage_ = 0;
};

} // namespace fettle::gantry
