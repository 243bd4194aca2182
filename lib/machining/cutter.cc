#include "machining/cutter.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace fettle::machining {
namespace {

/// A cone or a point with a smaller angle is numerically a cylinder, one as near to 90 degrees a plane.
constexpr double kMinHalfAngleDegrees = 0.001;

/// Height of the torus above the tip.
double torus_rise(const Cutter& c, double distance)
{
    const double from_disc = distance - c.flat;
    // r − √(r² − e²) without cancellation.
    return from_disc * from_disc /
           (c.corner + std::sqrt(std::max((c.corner - from_disc) * (c.corner + from_disc), 0.0)));
}

double positive_diameter(double diameter)
{
    if (!(diameter > 0)) throw core::InputError("the diameter must be positive, not " + core::to_text(diameter));
    require_within("the diameter", diameter, kLengthRange);
    return diameter;
}

/// Requires a radius of zero, a sharp edge or tip, or within the range of lengths.
void require_radius(const std::string& name, double radius)
{
    if (radius != 0) require_within(name, radius, kLengthRange);
}

Cutter tapered(double diameter, double half_angle_deg, double tip)
{
    const double radius = positive_diameter(diameter) / 2;
    require_within("the half angle", half_angle_deg, {kMinHalfAngleDegrees, 90 - kMinHalfAngleDegrees});
    require_radius("the tip's radius", tip);
    const double angle = half_angle_deg * std::numbers::pi / 180;
    const double cone_from = tip * std::cos(angle);
    if (cone_from > radius)
        throw core::InputError("a tip of radius " + core::to_text(tip) + " does not fit a diameter of " +
                               core::to_text(diameter));
    return {radius, 0, tip, cone_from, 1 / std::tan(angle)};
}

} // namespace

Cutter parse_cutter(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string_view list =
        colon == std::string::npos ? std::string_view() : std::string_view(text).substr(colon + 1);
    if (kind == "ball" || kind == "flat") {
        const double radius = positive_diameter(core::parse_number_list(list, {"the diameter"})[0]) / 2;
        return kind == "ball" ? Cutter{radius, 0, radius, radius, 0} : Cutter{radius, radius, 0, radius, 0};
    }
    if (kind == "bull") {
        const Eigen::VectorXd values = core::parse_number_list(list, {"the diameter", "the corner's radius"});
        const double radius = positive_diameter(values[0]) / 2, corner = values[1];
        require_radius("the corner's radius", corner);
        if (corner > radius)
            throw core::InputError("a corner of radius " + core::to_text(corner) + " does not fit a diameter of " +
                                   core::to_text(values[0]));
        return {radius, radius - corner, corner, radius, 0};
    }
    if (kind == "taper") {
        const Eigen::VectorXd values =
            core::parse_number_list(list, {"the diameter", "the half angle", "the tip's radius"});
        return tapered(values[0], values[1], values[2]);
    }
    throw core::InputError("expected ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r, got '" + text + "'");
}

double rise(const Cutter& cutter, double distance)
{
    if (!(distance <= cutter.radius)) return std::numeric_limits<double>::infinity();
    if (distance <= cutter.flat) return 0;
    if (distance <= cutter.cone_from) return torus_rise(cutter, distance);
    const double cone_rise = cutter.cone_from > cutter.flat ? torus_rise(cutter, cutter.cone_from) : 0;
    return cone_rise + cutter.cone_slope * (distance - cutter.cone_from);
}

double max_lead(const Cutter& cutter, double slope)
{
    const double climb = std::abs(slope);
    if (climb == 0) return 0;
    const double torus = cutter.flat + cutter.corner * climb / std::sqrt(1 + climb * climb);
    if (cutter.cone_from == cutter.radius) return torus;
    return std::max(torus, cutter.radius * std::min(1.0, climb / cutter.cone_slope));
}

Eigen::Vector3d tip_at_contact(const Cutter& cutter, const Eigen::Vector3d& contact, const Eigen::Vector3d& normal)
{
    // The steepest part of the lower side is the cone, or the vertical end of the torus.
    const double cone_z = 1 / std::sqrt(1 + cutter.cone_slope * cutter.cone_slope);
    const bool cone = cutter.cone_from < cutter.radius;
    constexpr double kNormalRounding = 1e-6; // files hold normals as float
    if (normal.z() < (cone ? cone_z : 0.0) - kNormalRounding)
        throw core::InputError("a cutter that comes from above cannot touch a surface with normal " +
                               core::to_short_text(normal.x()) + ", " + core::to_short_text(normal.y()) + ", " +
                               core::to_short_text(normal.z()));
    const double horizontal = normal.head<2>().norm();
    Eigen::Vector3d tip = contact + cutter.corner * normal;
    if (horizontal > 0) tip.head<2>() += cutter.flat / horizontal * normal.head<2>();
    tip.z() -= cutter.corner;
    return tip;
}

} // namespace fettle::machining
