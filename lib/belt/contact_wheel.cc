#include "belt/contact_wheel.h"

#include "core/text.h"
#include "units/units.h"
#include "json/document.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle::belt {

namespace {

using json::Reader;

// The largest wheel, mm: as the largest cell of a robot, 100 m.
constexpr double kMaxWheelLength = 1e5;
// Radius and width over the thickness of the layer. Cells of the contact's grid are a share of the radius and the
// width, and the layer's influence on one is integrated in steps of a thickness: a thinner layer would take minutes. Of
// real wheels the ratio is 100 at most.
constexpr double kMaxLengthThicknesses = 1e4;

double read_length(Reader& reader, const std::string& key, double mm)
{
    return mm * reader.number(key, {0, kMaxWheelLength / mm, false, true});
}

ElasticLayer read_layer(Reader reader, double mm)
{
    ElasticLayer layer;
    layer.thickness = mm * reader.number("thickness", core::Range::positive());
    layer.poisson = reader.number("poisson", core::Range::between(0, 0.5));
    if (reader.has("young") == reader.has("shore_a"))
        reader.refuse("young", "a layer has either \"young\" or \"shore_a\"");
    layer.young = reader.has("young") ? reader.number("young", core::Range::positive())
                                      : young_from_shore_a(reader.number("shore_a", core::Range::between(20, 95)));
    reader.reject_unknown_keys();
    return layer;
}

ContactWheel::Serration read_serration(Reader reader, double mm)
{
    ContactWheel::Serration serration;
    serration.pitch = mm * reader.number("pitch", core::Range::positive());
    serration.land = mm * reader.number("land", core::Range::positive());
    serration.depth = mm * reader.number("depth", core::Range::positive());
    serration.angle = reader.number_or("angle_deg", 0, core::Range::between(-90, 90)) * std::numbers::pi / 180;
    if (serration.land > serration.pitch) reader.refuse("land", "is wider than the pitch");
    reader.reject_unknown_keys();
    return serration;
}

BeltLaw read_law(Reader reader, double mm)
{
    BeltLaw law;
    const bool is_power_law = reader.choice("type", {"preston", "power"}) == "power";
    law.coefficient = reader.number("coefficient", core::Range::positive());
    if (is_power_law) {
        law.pressure_exponent = reader.number("pressure_exponent", core::Range::between(0, 5));
        law.speed_exponent = reader.number("speed_exponent", core::Range::between(-5, 5));
        law.feed_exponent = reader.number_or("feed_exponent", 0, core::Range::between(-5, 5));
        law.dwell_exponent = reader.number_or("dwell_exponent", 1, core::Range::between(0, 5));
        law.threshold = reader.number_or("threshold", 0, core::Range::at_least(0));
        law.coefficient *= std::pow(mm, 1 - law.speed_exponent - law.feed_exponent);
    }
    law.wear_work = kNewtonMmPerJoule * reader.number_or("wear_work", 0, core::Range::at_least(0));
    reader.reject_unknown_keys();
    return law;
}

json::Value to_json(const BeltLaw& law, const std::string& source)
{
    json::Value value;
    const bool is_preston = law.pressure_exponent == 1 && law.speed_exponent == 1 && law.feed_exponent == 0 &&
                            law.dwell_exponent == 1 && law.threshold == 0;
    value.set("type", is_preston ? "preston" : "power").set("coefficient", law.coefficient);
    if (!is_preston)
        value.set("pressure_exponent", law.pressure_exponent)
            .set("speed_exponent", law.speed_exponent)
            .set("feed_exponent", law.feed_exponent)
            .set("dwell_exponent", law.dwell_exponent)
            .set("threshold", law.threshold);
    value.set("wear_work", law.wear_work / kNewtonMmPerJoule);
    if (!source.empty()) value.set("source", source);
    return value;
}

} // namespace

double young_from_shore_a(double shore_a)
{
    constexpr double kMpaPerKgfCm2 = 0.0981;
    return kMpaPerKgfCm2 * (56 + 7.66 * shore_a) / (0.137505 * (254 - 2.54 * shore_a));
}

ContactWheel read_contact_wheel(const std::string& path)
{
    Reader reader = Reader::open(path);
    reader.expect_kind("wheel");
    Reader units = reader.object("units");
    const double mm = units::mm_per(units::parse_length_unit(units.choice("length", {"mm", "in", "m"})));
    units.choice("stress", {"MPa"});
    units.reject_unknown_keys();
    ContactWheel wheel;
    wheel.radius = read_length(reader, "radius", mm);
    wheel.width = read_length(reader, "width", mm);
    wheel.crown_radius = mm * reader.number_or("crown_radius", 0, core::Range::at_least(0));
    if (wheel.crown_radius > 0 && wheel.crown_radius < wheel.width / 2)
        reader.refuse("crown_radius", "is less than half the width");
    wheel.layer = read_layer(reader.object("layer"), mm);
    if (wheel.layer.thickness >= wheel.radius)
        reader.refuse("layer.thickness", "is not less than the radius of the wheel");
    if (wheel.layer.thickness * kMaxLengthThicknesses < std::max(wheel.radius, wheel.width))
        reader.refuse("layer.thickness", "is less than " + core::to_short_text(1 / kMaxLengthThicknesses) +
                                             " of the radius or the width, got " +
                                             core::to_short_text(wheel.layer.thickness / mm));
    if (auto serration = reader.optional_object("serration")) wheel.serration = read_serration(*serration, mm);
    wheel.belt_speed = mm * reader.number("belt_speed", core::Range::positive());
    Reader law = reader.object("law");
    wheel.law_source = law.text_or("source", "");
    wheel.law = read_law(law, mm);
    reader.optional_object("learnt"); // what the law was learnt from (calibrate/law_file.h)
    reader.reject_unknown_keys();
    return wheel;
}

json::Value to_json(const ContactWheel& wheel)
{
    json::Value value;
    value.set("kind", "wheel")
        .set("units", json::Value().set("length", "mm").set("stress", "MPa"))
        .set("radius", wheel.radius)
        .set("width", wheel.width)
        .set("crown_radius", wheel.crown_radius)
        .set("layer", json::Value()
                          .set("thickness", wheel.layer.thickness)
                          .set("young", wheel.layer.young)
                          .set("poisson", wheel.layer.poisson));
    if (const ContactWheel::Serration& grooves = wheel.serration; grooves.pitch > 0)
        value.set("serration", json::Value()
                                   .set("pitch", grooves.pitch)
                                   .set("land", grooves.land)
                                   .set("depth", grooves.depth)
                                   .set("angle_deg", grooves.angle * 180 / std::numbers::pi));
    return value.set("belt_speed", wheel.belt_speed).set("law", to_json(wheel.law, wheel.law_source));
}

double wheel_profile(const ContactWheel& wheel, double x, double y)
{
    if (std::abs(y) > wheel.width / 2 || std::abs(x) >= wheel.radius) return std::numeric_limits<double>::infinity();
    const auto arc_height = [](double radius, double t) {
        return t * t / (radius + std::sqrt(radius * radius - t * t));
    };
    double z = arc_height(wheel.radius, x) + (wheel.crown_radius > 0 ? arc_height(wheel.crown_radius, y) : 0);
    const ContactWheel::Serration& grooves = wheel.serration;
    if (grooves.pitch > 0) {
        const double pitches = (x * std::cos(grooves.angle) + y * std::sin(grooves.angle)) / grooves.pitch;
        if ((pitches - std::floor(pitches)) * grooves.pitch >= grooves.land) z += grooves.depth;
    }
    return z;
}

} // namespace fettle::belt
