#pragma once

#include "gantry/servo.h"

namespace fettle::gantry {

/// The controller of force_gains() with the largest K_p that keeps the sensitivity peak within kMaxSensitivity, with
/// the drive free and against the spring, around the drive's own tuned loop.
/// @param k, b  of the head's spring and damper, N/mm, N s/mm   @throws InputError if there is none
Pid tune_force(const Drive& drive, double k, double b, double period);

/// Response of the force loop around the drive and its servo controller, opened at the speed command.
/// @param load  mechanical load of the drive
LoopResponse force_response(const Drive& drive, const ServoGains& servo, const Oscillator& load, double period);

} // namespace fettle::gantry
