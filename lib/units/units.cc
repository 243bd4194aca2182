#include "units/units.h"

#include "core/error.h"

#include <cmath>

namespace fettle::units {

namespace {
constexpr double kMmPerInch = 25.4;               // exact by definition (1959)
constexpr double kNewtonPerLbf = 4.4482216152605; // exact by definition: 0.45359237 kg · 9.80665 m/s²
} // namespace

double mm_per(Units::Length length)
{
    return length == Units::Length::mm ? 1 : length == Units::Length::in ? kMmPerInch : 1000;
}

double Units::mm() const { return mm_per(length); }

double Units::newton() const { return force == Force::lbf ? kNewtonPerLbf : 1; }

std::string to_string(Units::Length length)
{
    return length == Units::Length::mm ? "mm" : length == Units::Length::in ? "in" : "m";
}

std::string to_string(Units::Force force) { return force == Units::Force::lbf ? "lbf" : "N"; }

Units::Length parse_length_unit(const std::string& word)
{
    for (const Units::Length length : {Units::Length::mm, Units::Length::in, Units::Length::m})
        if (word == to_string(length)) return length;
    throw core::InputError("unknown length unit '" + word + "' (mm, in or m)");
}

Units::Force parse_force_unit(const std::string& word)
{
    for (const Units::Force force : {Units::Force::N, Units::Force::lbf})
        if (word == to_string(force)) return force;
    throw core::InputError("unknown force unit '" + word + "' (N or lbf)");
}

double base_unit_factor(const Units& units, Dimension dimension)
{
    return std::pow(units.mm(), dimension.length_power) * std::pow(units.newton(), dimension.force_power);
}

} // namespace fettle::units
