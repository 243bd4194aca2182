#pragma once

#include "gantry/servo.h"

namespace fettle {

/// Holds the spring's deflection, and so the force, by the speed of the Z drive (Wang 2007, 6.1.4.1: PID):
/// v = K_p e + K_i ∫e + K_d ė, upwards negative e. It knows neither metal nor wheel: the spring alone makes the force.
struct ForceGains {
    double kp = 0; ///< 1/s
    double ki = 0; ///< 1/s²
    double kd = 0;
};

/// The integral and the derivative part that go with K_p.
ForceGains force_gains(double kp);

/// K_p as large as kMostSensitivity allows, with the spring at work and free, around the drive's own loop as tuned.
/// @param k, b  of the head's spring and damper, N/mm, N s/mm   @throws InputError if there is none
ForceGains tune_force(const Drive& drive, double k, double b, double period);

/// Of the loop opened at the speed.
/// @param load  what the drive carries
Margins force_margins(const ForceGains& gains, const Drive& drive, const ServoGains& servo, const Oscillator& load,
                      double period);

/// The controller at work, one call a period.
class ForceLoop {
  public:
    /// @param speed, acceleration  the largest of the drive
    ForceLoop(const ForceGains& gains, double period, double speed, double acceleration)
        : gains_(gains), period_(period), speed_(speed), acceleration_(acceleration)
    {
    }

    /// @param wanted, seen  deflection, mm   @param velocity  of the command, upwards, mm/s   @param down  the fastest
    /// @return  that of the next period
    double step(double wanted, double seen, double velocity, double down);

  private:
    ForceGains gains_;
    double period_, speed_, acceleration_;
    double integral_ = 0, last_ = 0;
    bool begun_ = false;
};

} // namespace fettle
