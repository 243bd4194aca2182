#pragma once

#include "removal/wheel.h"

namespace fettle::removal {

/// The spring of the head, compressed in its housing: it can only be compressed more (Wang 2007, 6.1.3).
struct Spring {
    double preload = 0;   ///< N
    double stiffness = 0; ///< N/mm

    /// Force with the wheel off its stop by `deflection` ≥ 0, upward.
    double force(double deflection) const { return preload + stiffness * deflection; }
};

/// Equilibrium of the wheel against the stock.
struct Balance {
    double z_tip = 0;  ///< of the wheel's lowest line, mm
    double force = 0;  ///< N
    double volume = 0; ///< that it removes, mm³
    double push = 0;   ///< on the wheel, along Y_w, N
};

/// The head pressed on the stock for a short while. By Preston's law summed over the contact the volume removed is
/// c · F · dt (Wang 2007, 6.1.2: deeper with more force, shallower with more feed), and it is the stock above the
/// wheel's rim. F is normal to the rim, the spring carries its vertical part (RimForce): overlap(z).lift = c dt F(z).
/// The left side falls with z, the right side grows: one solution. If the wheel removes less even at its stop, it stays
/// there and the force is what that took, at most the preload.
/// @param z_stop  z_tip without deflection
/// @param c_dt    removal coefficient · duration, mm³/N
/// @param guess   of z_tip
Balance press(const WheelInStock& wheel, const Spring& spring, double z_stop, double c_dt, double guess);

} // namespace fettle::removal
