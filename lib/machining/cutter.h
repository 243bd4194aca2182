#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle {

/// A rotating cutter as it clears material: round about its axis, +z from the tip (the lowest point on the axis) to the
/// holder. From the axis outwards its lower side is a flat disc, a quarter of a torus (of a ball, if there is no disc)
/// and a cone; parts that a cutter has not have no width. What is above the lower side clears material too.
struct Cutter {
    double radius = 0;     ///< of the whole cutter, mm
    double flat = 0;       ///< radius of the disc, mm
    double corner = 0;     ///< radius of the torus's section, mm
    double cone_from = 0;  ///< distance from the axis at which the cone begins, mm; `radius`: no cone
    double cone_slope = 0; ///< rise of the cone per distance from the axis
};

/// "ball:D", "flat:D", "bull:D,r", "taper:D,halfangle_deg,r"; D is the diameter, of a taper that of its shank, r the
/// radius of the corner, of a taper that of the ball at its tip (0: a point).
/// @throws InputError for anything else, a radius that does not fit the diameter, or an angle not within 0 to 90
Cutter parse_cutter(const std::string& text);

/// Height of the lower side over the tip, mm, at a distance from the axis; infinite beyond the radius.
double rise(const Cutter& cutter, double distance);

/// A cutter moves up by `slope` for each unit of way along +x. Its lead over a point beside the way is where, relative
/// to the point, its axis is when its lower side over the point is at its lowest: the x that makes the convex function
/// slope·x + rise(√(x² + across²)) least (of a flat side on the level the middle). No |lead| is greater than this.
double greatest_lead(const Cutter& cutter, double slope);

/// Where the tip is when the cutter touches a surface (cutter location, CL) from where it touches it (cutter contact,
/// CC).
/// @param normal  unit, outward
/// @throws InputError if no point of the cutter's lower side has this normal
Eigen::Vector3d tip_at_contact(const Cutter& cutter, const Eigen::Vector3d& contact, const Eigen::Vector3d& normal);

} // namespace fettle
