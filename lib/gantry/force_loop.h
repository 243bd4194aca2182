#pragma once

#include "gantry/loop_response.h"

namespace fettle::gantry {

/// PID control of the force by the speed of the Z drive; the feedback is the spring's deflection (Wang 2007, 6.1.4.1):
/// v = K_p e + K_i ∫e + K_d ė, a positive error e moves down; K_p in 1/s, K_i in 1/s². It needs no model of metal and
/// wheel: the spring alone makes the force.
/// @return  the controller with that K_p, and an integral and a derivative part in a fixed relation to it
Pid force_gains(double kp);

/// The controller, one call a period.
class ForceLoop {
  public:
    /// @param speed, acceleration  limits of the drive, mm/s, mm/s²
    ForceLoop(const Pid& gains, double period, double speed, double acceleration)
        : gains_(gains), period_(period), speed_(speed), acceleration_(acceleration)
    {
    }

    /// @param desired, measured  deflection, mm
    /// @param velocity           of the command, upwards, mm/s
    /// @param max_down           fastest speed downwards, mm/s
    /// @return  velocity of the command in the next period
    double step(double desired, double measured, double velocity, double max_down);

  private:
    Pid gains_;
    double period_, speed_, acceleration_;
    double integral_ = 0, last_error_ = 0;
    bool has_last_error_ = false;
};

} // namespace fettle::gantry
