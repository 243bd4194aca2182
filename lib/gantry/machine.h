#pragma once

#include <array>
#include <string>

namespace fettle::gantry {

/// A drive referred to its nut: motor, gears and screw of Wang 2007, eq. 6-1, 6-2 and 6-5, multiplied by K_b / K so
/// that all is in mm and N (a rotary axis: rad and N mm). The motor's angle is that of the screw, θ = K_b p with
/// K_b = 2π / pitch; a force f at the nut is a torque K f + C with K = 1 / (η K_b), or power would come from nothing.
struct Drive {
    double mass = 0;    ///< η K_b² J, N s²/mm
    double damping = 0; ///< η K_b² B, N s/mm; B includes the motor's own brake, its electromotive force: N² K_m² / R_m
    double gain = 0;    ///< η K_b N K_m / R_m, N/V
    double load = 0;    ///< η K_b C, N: constant, in the direction of −p
    double voltage = 0;                        ///< limit of the amplifier, ±V
    double current = 0;                        ///< voltage drop of the amplifier's largest current over R_m, V
    double emf = 0;                            ///< electromotive force per speed, K_m N K_b, V s/mm
    double encoder = 0;                        ///< one count, mm
    double speed = 0, acceleration = 0;        ///< limits of its commands, mm/s, mm/s²
    double min_position = 0, max_position = 0; ///< mm
    double following_error = 0;                ///< farther from its command it is switched off, mm
};

/// The head: a spring (specified in the job) and a damper carry the grinder, which can only move up from its stop.
struct Head {
    double damping = 0;   ///< b, N s/mm
    double travel = 0;    ///< largest deflection, mm
    double lvdt = 0;      ///< resolution of the transducer that measures the deflection, mm
    double noise = 0;     ///< its standard deviation, mm
    double stiffness = 0; ///< of machine and head against forces across the spring, in the wheel's plane, N/mm
};

/// The spindle, and ratios of forces to the normal force (Wang 2007, fig. 6-3).
struct Spindle {
    double speed = 0;      ///< rad/s
    double power = 0;      ///< N mm/s
    double inertia = 0;    ///< of rotor and wheel, N mm s²
    double tangential = 0; ///< F_t / F_n
    double side = 0;       ///< F_a / F_n while the wheel moves along its axis
};

/// A gantry grinder with servo drives ("kind": "machine").
struct Machine {
    std::string source = "machine"; ///< the file's name, for messages
    std::array<Drive, 3> axes;      ///< X, Y, Z; Z upwards
    Drive c;                        ///< turns the head about Z, rad
    Head head;
    Spindle spindle;
    double period = 1e-3; ///< of the servo loops, s
};

/// Reads a machine file.
/// @throws InputError with the key's path: also for a drive that cannot reach its speed or acceleration
Machine read_machine(const std::string& path);

} // namespace fettle::gantry
