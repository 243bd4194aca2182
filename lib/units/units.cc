#include "units/units.h"

#include "core/error.h"

#include <cmath>

namespace fettle {

namespace {
constexpr double kMmPerInch = 25.4;               // exact by definition (1959)
constexpr double kNewtonPerLbf = 4.4482216152605; // exact by definition: 0.45359237 kg · 9.80665 m/s²
} // namespace

double mm_per(Units::Length length)
{
    switch (length) {
    case Units::Length::mm:
        return 1;
    case Units::Length::in:
        return kMmPerInch;
    case Units::Length::m:
        break;
    }
    return 1000;
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
    throw InputError("unknown length unit '" + word + "' (mm, in or m)");
}

Units::Force parse_force_unit(const std::string& word)
{
    for (const Units::Force force : {Units::Force::N, Units::Force::lbf})
        if (word == to_string(force)) return force;
    throw InputError("unknown force unit '" + word + "' (N or lbf)");
}

double to_base(const Units& units, Dimension dimension)
{
    return std::pow(units.mm(), dimension.length_power) * std::pow(units.newton(), dimension.force_power);
}

} // namespace fettle
