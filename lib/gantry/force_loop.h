#pragma once

#include "gantry/loop_response.h"

namespace fettle {

/// The force is held by the speed of the Z drive, told by the spring's deflection (Wang 2007, 6.1.4.1: PID):
/// v = K_p e + K_i ∫e + K_d ė, upwards negative e; K_p in 1/s, K_i in 1/s². It knows neither metal nor wheel: the
/// spring alone makes the force.
/// @return  the controller with that K_p: the integral and the derivative part go with it
Pid force_gains(double kp);

/// The controller at work, one call a period.
class ForceLoop {
  public:
    /// @param speed, acceleration  the largest of the drive
    ForceLoop(const Pid& gains, double period, double speed, double acceleration)
        : gains_(gains), period_(period), speed_(speed), acceleration_(acceleration)
    {
    }

    /// @param wanted, seen  deflection, mm   @param velocity  of the command, upwards, mm/s   @param down  the fastest
    /// @return  that of the next period
    double step(double wanted, double seen, double velocity, double down);

  private:
    Pid gains_;
    double period_, speed_, acceleration_;
    double integral_ = 0, last_ = 0;
    bool begun_ = false;
};

} // namespace fettle
