#pragma once

#include "belt/belt_law.h"
#include "belt/layer_compliance.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>

namespace fettle::belt {

inline constexpr double kNewtonMmPerJoule = 1000; ///< N mm

/// A contact wheel under a grinding belt: an elastic layer on a rigid hub. The axis is y of the tool frame; the origin
/// is the lowest point, at the middle of the width.
struct ContactWheel {
    double radius = 0;       ///< mm
    double width = 0;        ///< mm
    double crown_radius = 0; ///< of the arc across the width, mm; 0: none
    ElasticLayer layer;
    /// Equal grooves across the layer; pitch 0: none.
    struct Serration {
        double pitch = 0; ///< from groove to groove, mm
        double land = 0;  ///< width of the ridge between two grooves, mm
        double depth = 0; ///< mm
        double angle = 0; ///< between grooves and wheel axis, rad
    } serration;
    double belt_speed = 0; ///< V_b, mm/s
    BeltLaw law;
    std::string law_source; ///< where the law comes from; may be empty
};

/// Young's modulus of a rubber from its Shore A hardness (Gent 1958), MPa: within 10 % from 30 to 70.
double young_from_shore_a(double shore_a);

/// Reads a file of kind "wheel" (docs/formats.md).
/// @throws InputError naming the key if the file is not a valid wheel
ContactWheel read_contact_wheel(const std::string& path);

/// As the file that read_contact_wheel() reads, in mm; the layer with its modulus, the law as a power law unless it is
/// Preston's.
json::Value to_json(const ContactWheel& wheel);

/// Height of the undeformed wheel over the tangent plane at its lowest point, mm; infinite beyond its width or radius.
/// An edge of a land passes through the origin.
/// @param x, y  tool frame, mm
double wheel_profile(const ContactWheel& wheel, double x, double y);

} // namespace fettle::belt
