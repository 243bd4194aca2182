#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle::machining {

/// Envelope of a rotating cutter (APT cutter): a solid of revolution, +z from the tip (the lowest point on the axis) to
/// the holder. From the axis outwards its lower side is a flat disc, a quarter of a torus (a ball, if there is no disc)
/// and a cone; each of them may have no width. Everything above the lower side clears material too.
struct Cutter {
    double radius = 0;     ///< outer radius, mm
    double flat = 0;       ///< radius of the disc, mm
    double corner = 0;     ///< corner radius: of the torus's section, mm
    double cone_from = 0;  ///< distance from the axis at which the cone begins, mm; `radius`: no cone
    double cone_slope = 0; ///< rise of the cone per distance from the axis
};

/// Parses "ball:D", "flat:D", "bull:D,r" or "taper:D,halfangle_deg,r". D is the diameter (of a taper: the shank's), r
/// the corner radius (of a taper: the radius of the ball at its tip; 0: a point). mm.
/// @throws InputError for anything else, a radius that does not fit the diameter, or an angle not within 0 to 90
Cutter parse_cutter(const std::string& text);

/// Height of the lower side above the tip at a distance from the axis, mm; infinite beyond the radius.
double rise(const Cutter& cutter, double distance);

/// Upper bound of |lead|. The cutter climbs by `slope` for each unit of travel along +x. Its lead over a point is the
/// position of its axis relative to the point when its lower side is lowest over the point: the minimiser x of the
/// convex function slope·x + rise(√(x² + across²)); the middle if a flat side moves horizontally.
double max_lead(const Cutter& cutter, double slope);

/// Position of the tip (cutter location, CL) from the point where the cutter touches a surface (cutter contact, CC).
/// @param contact  mm, tool frame: +z along the cutter's axis   @param normal  unit, outward
/// @throws InputError if no point of the cutter's lower side has this normal
Eigen::Vector3d tip_at_contact(const Cutter& cutter, const Eigen::Vector3d& contact, const Eigen::Vector3d& normal);

} // namespace fettle::machining
