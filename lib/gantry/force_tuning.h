#pragma once

#include "gantry/servo.h"

namespace fettle {

/// The controller of force_gains() with K_p as large as kMostSensitivity allows, with the spring at work and free,
/// around the drive's own loop as tuned.
/// @param k, b  of the head's spring and damper, N/mm, N s/mm   @throws InputError if there is none
Pid tune_force(const Drive& drive, double k, double b, double period);

/// Of the loop around the drive and its own controller, opened at the speed.
/// @param load  what the drive carries
LoopResponse force_response(const Drive& drive, const ServoGains& servo, const Oscillator& load, double period);

} // namespace fettle
