#include "machining/cutter.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/number_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

namespace fettle {
namespace {

/// Height over the tip where the torus ends.
double torus_rise(const Cutter& c, double distance)
{
    const double from_disc = distance - c.flat;
    // r − √(r² − e²) without the difference of near numbers
    return from_disc * from_disc /
           (c.corner + std::sqrt(std::max((c.corner - from_disc) * (c.corner + from_disc), 0.0)));
}

double positive_diameter(double diameter)
{
    if (!(diameter > 0)) throw InputError("the diameter must be positive, not " + to_text(diameter));
    return diameter;
}

Cutter tapered(double diameter, double half_angle_deg, double tip)
{
    const double radius = positive_diameter(diameter) / 2;
    if (!(half_angle_deg > 0 && half_angle_deg < 90))
        throw InputError("the half angle must be within 0 to 90 degrees, not " + to_text(half_angle_deg));
    const double angle = half_angle_deg * std::numbers::pi / 180;
    const double cone_from = tip * std::cos(angle);
    if (!(tip >= 0 && cone_from <= radius))
        throw InputError("a tip of radius " + to_text(tip) + " does not fit a diameter of " + to_text(diameter));
    return {radius, 0, tip, cone_from, 1 / std::tan(angle)};
}

} // namespace

Cutter parse_cutter(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string_view list =
        colon == std::string::npos ? std::string_view() : std::string_view(text).substr(colon + 1);
    if (kind == "ball") {
        const double radius = positive_diameter(numbers_of(list, {"the diameter"})[0]) / 2;
        return {radius, 0, radius, radius, 0};
    }
    if (kind == "flat") {
        const double radius = positive_diameter(numbers_of(list, {"the diameter"})[0]) / 2;
        return {radius, radius, 0, radius, 0};
    }
    if (kind == "bull") {
        const auto values = numbers_of(list, {"the diameter", "the corner's radius"});
        const double radius = positive_diameter(values[0]) / 2, corner = values[1];
        if (!(corner >= 0 && corner <= radius))
            throw InputError("a corner of radius " + to_text(corner) + " does not fit a diameter of " +
                             to_text(values[0]));
        return {radius, radius - corner, corner, radius, 0};
    }
    if (kind == "taper") {
        const auto values = numbers_of(list, {"the diameter", "the half angle", "the tip's radius"});
        return tapered(values[0], values[1], values[2]);
    }
    throw InputError("expected ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r, got '" + text + "'");
}

double rise(const Cutter& cutter, double distance)
{
    if (!(distance <= cutter.radius)) return std::numeric_limits<double>::infinity();
    if (distance <= cutter.flat) return 0;
    if (distance <= cutter.cone_from) return torus_rise(cutter, distance);
    const double cone_rise = cutter.cone_from > cutter.flat ? torus_rise(cutter, cutter.cone_from) : 0;
    return cone_rise + cutter.cone_slope * (distance - cutter.cone_from);
}

double greatest_lead(const Cutter& cutter, double slope)
{
    const double up = std::abs(slope);
    if (up == 0) return 0;
    const double round = cutter.flat + cutter.corner * up / std::sqrt(1 + up * up);
    if (cutter.cone_from == cutter.radius) return round;
    return std::max(round, cutter.radius * std::min(1.0, up / cutter.cone_slope));
}

Eigen::Vector3d tip_at_contact(const Cutter& cutter, const Eigen::Vector3d& contact, const Eigen::Vector3d& normal)
{
    // The steepest part of the lower side: the cone, or the upright end of the torus.
    const double least_z = 1 / std::sqrt(1 + cutter.cone_slope * cutter.cone_slope);
    const bool cone = cutter.cone_from < cutter.radius;
    constexpr double kRounding = 1e-6; // of normals, which files hold as float
    if (normal.z() < (cone ? least_z : 0.0) - kRounding)
        throw InputError("a cutter that comes from above cannot touch a surface with normal " +
                         to_short_text(normal.x()) + ", " + to_short_text(normal.y()) + ", " +
                         to_short_text(normal.z()));
    const double level = normal.head<2>().norm();
    Eigen::Vector3d tip = contact + cutter.corner * normal;
    if (level > 0) tip.head<2>() += cutter.flat / level * normal.head<2>();
    tip.z() -= cutter.corner;
    return tip;
}

} // namespace fettle
