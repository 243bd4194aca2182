#pragma once

namespace fettle::belt {

/// Removal law of a belt: depth rate = coefficient · (p - threshold)^pressure · V_b^speed · V_w^feed, in MPa, mm/s and
/// s, for a new belt. The rate has fallen to 1/e when the belt has done `wear_work`; work is force · V_b · time, which
/// is the friction work divided by the friction coefficient. The default exponents are Preston's law (1927), the local
/// form of Hammann's (Ren et al. 2006, eq. 5) with C_A K_A = coefficient and k_t = the wear of the belt.
struct BeltLaw {
    double coefficient = 0; ///< (mm/s) / (MPa^pressure (mm/s)^(speed + feed))
    double pressure_exponent = 1, speed_exponent = 1, feed_exponent = 0; ///< exponents
    double dwell_exponent = 1;                                           ///< exponent of the dwell time in s
    double threshold = 0; ///< pressure below which the belt does not cut, MPa
    double wear_work = 0; ///< N mm; 0: the belt does not wear
};

/// Removal during one contact as a function of the pressure in it: depth = scale · (p - threshold)^exponent. It
/// grows with p, so that the contact with removal has one solution as the contact without has (layer_contact.h).
struct RemovalStep {
    double scale = 0; ///< mm / MPa^exponent; 0: nothing is removed
    double exponent = 1;
    double threshold = 0; ///< MPa

    bool is_linear() const { return exponent == 1 && threshold == 0; }
    /// Depth, mm.  @param p  MPa; below the threshold nothing is removed
    double depth(double p) const;
    /// Derivative of the depth, mm/MPa.
    double slope(double p) const;
    /// A share of the removal.
    RemovalStep scaled(double share) const { return {scale * share, exponent, threshold}; }
};

/// Removal by a law in `duration`.
/// @param belt_speed, feed  mm/s   @param duration  s
/// @param prior_work  that the belt did before, N mm
RemovalStep removal_step(const BeltLaw& law, double belt_speed, double feed, double duration, double prior_work);

} // namespace fettle::belt
