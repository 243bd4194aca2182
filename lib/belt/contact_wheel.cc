#include "belt/contact_wheel.h"

#include "units/units.h"
#include "json/document.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {

namespace {

using json::Reader;

ElasticLayer layer_in(Reader reader, double mm)
{
    ElasticLayer layer;
    layer.thickness = mm * reader.number("thickness", Range::positive());
    layer.poisson = reader.number("poisson", Range::between(0, 0.5));
    if (reader.has("young") == reader.has("shore_a"))
        reader.refuse("young", "a layer has either \"young\" or \"shore_a\"");
    layer.young = reader.has("young") ? reader.number("young", Range::positive())
                                      : young_of_shore(reader.number("shore_a", Range::between(20, 95)));
    reader.done();
    return layer;
}

ContactWheel::Serration serration_in(Reader reader, double mm)
{
    ContactWheel::Serration serration;
    serration.pitch = mm * reader.number("pitch", Range::positive());
    serration.land = mm * reader.number("land", Range::positive());
    serration.depth = mm * reader.number("depth", Range::positive());
    serration.angle = reader.number_or("angle_deg", 0, Range::between(-90, 90)) * std::numbers::pi / 180;
    if (serration.land > serration.pitch) reader.refuse("land", "is wider than the pitch");
    reader.done();
    return serration;
}

BeltLaw law_in(Reader reader, double mm)
{
    BeltLaw law;
    const bool is_general = reader.choice("type", {"preston", "power"}) == "power";
    law.coefficient = reader.number("coefficient", Range::positive());
    if (is_general) {
        law.pressure = reader.number("pressure_exponent", Range::between(0, 5));
        law.speed = reader.number("speed_exponent", Range::between(-5, 5));
        law.feed = reader.number_or("feed_exponent", 0, Range::between(-5, 5));
        law.dwell = reader.number_or("dwell_exponent", 1, Range::between(0, 5));
        law.threshold = reader.number_or("threshold", 0, Range::at_least(0));
        law.coefficient *= std::pow(mm, 1 - law.speed - law.feed);
    }
    law.wear_work = kJoule * reader.number_or("wear_work", 0, Range::at_least(0));
    reader.done();
    return law;
}

} // namespace

double removed_depth(const BeltLaw& law, double p, double belt_speed, double feed, double duration, double worn)
{
    if (!(p > law.threshold)) return 0;
    const double sharpness = law.wear_work > 0 ? std::exp(-worn / law.wear_work) : 1;
    return law.coefficient * std::pow(p - law.threshold, law.pressure) * std::pow(belt_speed, law.speed) *
           std::pow(feed, law.feed) * sharpness * duration;
}

double young_of_shore(double shore_a)
{
    constexpr double kUnit = 0.0981; // kgf/cm² in MPa
    return kUnit * (56 + 7.66 * shore_a) / (0.137505 * (254 - 2.54 * shore_a));
}

ContactWheel read_contact_wheel(const std::string& path)
{
    Reader reader = Reader::open(path);
    reader.expect_kind("wheel");
    Reader units = reader.object("units");
    const double mm = mm_per(parse_length_unit(units.choice("length", {"mm", "in", "m"})));
    units.choice("stress", {"MPa"});
    units.done();
    ContactWheel wheel;
    wheel.radius = mm * reader.number("radius", Range::positive());
    wheel.width = mm * reader.number("width", Range::positive());
    wheel.crown_radius = mm * reader.number_or("crown_radius", 0, Range::at_least(0));
    if (wheel.crown_radius > 0 && wheel.crown_radius < wheel.width / 2)
        reader.refuse("crown_radius", "is less than half the width");
    wheel.layer = layer_in(reader.object("layer"), mm);
    if (wheel.layer.thickness >= wheel.radius) reader.refuse("layer.thickness", "leaves no hub");
    if (auto serration = reader.object_or_none("serration")) wheel.serration = serration_in(*serration, mm);
    wheel.belt_speed = mm * reader.number("belt_speed", Range::positive());
    wheel.law = law_in(reader.object("law"), mm);
    reader.done();
    return wheel;
}

double profile(const ContactWheel& wheel, double x, double y)
{
    if (std::abs(y) > wheel.width / 2 || std::abs(x) >= wheel.radius) return std::numeric_limits<double>::infinity();
    const auto arc = [](double radius, double at) { return at * at / (radius + std::sqrt(radius * radius - at * at)); };
    double z = arc(wheel.radius, x) + (wheel.crown_radius > 0 ? arc(wheel.crown_radius, y) : 0);
    const ContactWheel::Serration& grooves = wheel.serration;
    if (grooves.pitch > 0) {
        const double across = (x * std::cos(grooves.angle) + y * std::sin(grooves.angle)) / grooves.pitch;
        if ((across - std::floor(across)) * grooves.pitch >= grooves.land) z += grooves.depth;
    }
    return z;
}

} // namespace fettle
