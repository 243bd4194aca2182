#pragma once

#include "belt/layer_compliance.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

inline constexpr double kJoule = 1000; ///< N mm

/// How fast a belt removes metal: depth per time = coefficient · (p - threshold)^pressure · V_b^speed · V_w^feed, in
/// MPa, mm/s and s, as long as the belt is new; it falls to 1/e when the belt has done `wear_work`. Work is force · V_b
/// · time, what friction does over its coefficient. With all exponents as they stand here it is Preston's law (1927),
/// the local form of Hammann's (Ren et al. 2006, eq. 5): C_A K_A = coefficient, k_t = the belt's wear.
struct BeltLaw {
    double coefficient = 0; ///< (mm/s) / (MPa^pressure (mm/s)^(speed + feed))
    double pressure = 1, speed = 1, feed = 0;
    double dwell = 1;     ///< of the time, in s, that the wheel stands at a place
    double threshold = 0; ///< MPa; less does not cut
    double wear_work = 0; ///< N mm; 0: the belt does not wear
};

/// Depth that pressure p removes in `duration`, mm. @param worn  work of the belt before, N mm
double removed_depth(const BeltLaw& law, double p, double belt_speed, double feed, double duration, double worn);

/// A contact wheel under a grinding belt: an elastic layer on a rigid hub. Its axis is the tool frame's y, its lowest
/// point, at the middle of its width, the origin.
struct ContactWheel {
    double radius = 0;       ///< mm
    double width = 0;        ///< mm
    double crown_radius = 0; ///< of the arc across the width, mm; 0: none
    ElasticLayer layer;
    /// Grooves across the layer, all alike; pitch 0: none.
    struct Serration {
        double pitch = 0; ///< from groove to groove, mm
        double land = 0;  ///< of it not grooved, mm
        double depth = 0; ///< mm
        double angle = 0; ///< of the grooves from the wheel's axis, rad
    } serration;
    double belt_speed = 0; ///< V_b, mm/s
    BeltLaw law;
};

/// Young's modulus of a rubber by its hardness Shore A (Gent 1958), MPa: within a tenth from 30 to 70.
double young_of_shore(double shore_a);

/// Kind "wheel" (docs/formats.md).
/// @throws InputError for a file that is not one, naming the key
ContactWheel read_contact_wheel(const std::string& path);

/// Height of the undeformed wheel over the plane through its lowest point, mm; infinite beyond its width or radius. A
/// land's edge goes through the origin.
double profile(const ContactWheel& wheel, double x, double y);

} // namespace fettle
