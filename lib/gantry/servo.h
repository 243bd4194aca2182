#pragma once

#include "gantry/exact_step.h"
#include "gantry/machine.h"

#include <complex>
#include <functional>
#include <numbers>

namespace fettle {

/// What a drive is asked to do at the beginning of a period: the acceleration is kept for the whole of it.
struct Reference {
    double p = 0, v = 0, a = 0;
};

/// V = K_p e + K_i ∫e + K_d ė + K_v v + K_a a + V_0: PID and feed-forward.
struct ServoGains {
    double kp = 0, ki = 0, kd = 0;
    double kv = 0, ka = 0, v0 = 0;
    double bandwidth = 0; ///< ω of the slowest poles, rad/s
};

/// Largest |1 / (1 + L)| of the sampled loop over all frequencies. M means a gain margin of at least M / (M − 1) and a
/// phase margin of at least 2 asin(1 / 2M) (Åström and Murray 2008, 9.3).
double sensitivity_peak(const ServoGains& gains, double drive_gain, const Oscillator& load, double period);

/// What a loop bears before it swings without end.
struct Margins {
    double gain = 1e6;               ///< factor on its gain, upwards
    double phase = std::numbers::pi; ///< rad
    double sensitivity = 0;          ///< the peak
};
/// @param open_loop  L(z), stable when closed
Margins margins(const std::function<std::complex<double>(std::complex<double>)>& open_loop);
Margins margins(const ServoGains& gains, double drive_gain, const Oscillator& load, double period);

/// The stated margin of every loop: gain 3, phase 38.9°.
inline constexpr double kMostSensitivity = 1.5;

/// Places the poles at −ω (and a third one farther out where the drive brakes itself more), ω as large as two
/// conditions allow: the sensitivity peak of the sampled loop, free and with the spring (k, b) at work, stays within
/// kMostSensitivity; one count of the encoder moves the voltage by no more than a tenth of what the amplifier has.
/// Feed-forward is the inverse of the drive.
/// @throws InputError if there is none
ServoGains tune(const Drive& drive, double k, double b, double period);

/// One axis: drive, encoder and controller. Between two looks of the controller its voltage stands, and the motion is
/// exact.
class ServoAxis {
  public:
    /// @param k, b  spring and damper that may load the drive, N/mm, N s/mm
    ServoAxis(const Drive& drive, double k, double b, double period, double at);

    /// One period under a constant force (towards +p).
    void step(const Reference& reference, double force);
    /// One period against the spring and the damper, whose other end stands at `end` and moves on evenly at `rate`
    /// (Wang 2007, eq. 6-7; there the damper's share of the other end, K b ż_r, is missing on the right).
    void step_with_spring(const Reference& reference, double preload, double end, double rate);

    const Motion& motion() const { return motion_; }
    double measured() const { return measured_; } ///< by the encoder
    double voltage() const { return voltage_; }
    const ServoGains& gains() const { return gains_; }

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

} // namespace fettle
