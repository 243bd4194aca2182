#include "draw/field_scale.h"

#include "cloud/fields.h"
#include "core/error.h"
#include "core/text.h"
#include "job/region.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace fettle::draw {
namespace {

using Eigen::Index;

// Smallest span of a scale relative to its largest value: closer ticks would need more digits than a label shows.
constexpr double kMinRelativeSpan = 1e-9;

// YlGnBu of ColorBrewer (Cynthia Brewer, Apache-2.0) without its palest and its darkest two: darkens evenly, is safe
// for colour blindness, and light enough for shading.
constexpr std::array<Rgb, 6> kSequential = {
    {{237, 248, 177}, {199, 233, 180}, {127, 205, 187}, {65, 182, 196}, {29, 145, 192}, {34, 94, 168}}};

Rgb sequential(double share)
{
    const double position = std::clamp(share, 0.0, 1.0) * (kSequential.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(position), kSequential.size() - 2);
    Rgb mixed;
    for (std::size_t i = 0; i < 3; ++i)
        mixed[i] = static_cast<std::uint8_t>(
            std::lround(std::lerp(kSequential[below][i], kSequential[below + 1][i], position - double(below))));
    return mixed;
}

/// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below x.
double round_up(double x)
{
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (digit * power >= x * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

constexpr Rgb kWithin = {150, 200, 120}; // green, between the two ends in brightness

struct NamedClass {
    double value;
    const char* name;
    double place; ///< on the diverging scale, -1 to 1
};
constexpr std::array<NamedClass, 3> kSurfelClasses = {{{-1, "gouge", -0.8}, {0, "within", 0}, {1, "undercut", 0.8}}};
constexpr std::array<NamedClass, 5> kPatchClasses = {{{-2, "serious over-cut", -1},
                                                      {-1, "slight over-cut", -0.5},
                                                      {0, "neutral", 0},
                                                      {1, "slight under-cut", 0.5},
                                                      {2, "serious under-cut", 1}}};

} // namespace

Rgb PictureScale::operator()(double value) const
{
    if (std::isnan(value)) return kUndefinedColour;
    if (packed) return unpacked(value);
    if (!classes.empty()) {
        const auto found = std::ranges::find(classes, value, &FieldClass::value);
        return found == classes.end() ? kUndefinedColour : found->colour;
    }
    double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
    if (bands > 0) share = (std::min(std::floor(share * bands), bands - 1.0) + 0.5) / bands;
    return diverging ? ColourScale{1, palette}(2 * share - 1) : sequential(share);
}

PictureScale scale_for(const std::string& field, const Eigen::VectorXd& values, const ScaleOptions& options)
{
    PictureScale scale;
    scale.bands = options.bands;
    scale.palette = options.palette;
    scale.diverging = field == "error";
    if (options.range) {
        std::tie(scale.low, scale.high) = *options.range;
        return scale;
    }
    if (scale.diverging) {
        scale.high = options.scale ? *options.scale : round_up(colour_scale(values, 0).limit);
        scale.low = -scale.high;
        return scale;
    }
    double min = std::numeric_limits<double>::infinity(), max = -min;
    for (const double value : values)
        if (std::isfinite(value)) {
            min = std::min(min, value);
            max = std::max(max, value);
        }
    scale.low = std::isfinite(min) ? min : 0;
    const double span = options.scale ? *options.scale : max - min;
    // If all values are equal, or there are none, the scale still gets a span.
    scale.high = scale.low + (std::isfinite(span) && span > kMinRelativeSpan * std::max(1.0, std::abs(max)) ? span : 1);
    return scale;
}

PictureScale class_scale(const cloud::Cloud& cloud, const Eigen::VectorXd& chosen, Palette palette)
{
    PictureScale scale;
    scale.palette = palette;
    const auto add = [&](double value, const std::string& name, const Rgb& colour) {
        scale.classes.push_back({value, name, colour, (chosen.array() == value).count()});
    };
    const auto add_named = [&](const auto& named) {
        for (const auto& [value, name, place] : named)
            add(value, name, place == 0 ? kWithin : ColourScale{1, palette}(place));
    };
    if (cloud::has_field(cloud, "d"))
        add_named(kPatchClasses);
    else
        add_named(kSurfelClasses);
    for (const double value : cloud::field(cloud, "class"))
        if (!std::isnan(value) && std::ranges::find(scale.classes, value, &FieldClass::value) == scale.classes.end()) {
            constexpr std::size_t kMaxClasses = 20;
            if (scale.classes.size() == kMaxClasses)
                throw core::InputError("field 'class' has more than 20 different values: these are no classes");
            add(value, "class " + core::to_short_text(value),
                sequential(double(scale.classes.size()) / double(kMaxClasses)));
        }
    return scale;
}

std::string unit_of_field(const std::string& field, const units::Units& units)
{
    const units::Dimension d = field == "z" ? units::Dimension{1, 0} : cloud::field_dimension(field);
    const std::string length = units::to_string(units.length), force = units::to_string(units.force);
    if (d.force_power == 0 && d.length_power == 0) return "";
    if (d.force_power == 0 && field == "feed") return length + "/s";
    const auto to_the = [&](int power) { return length + (power == 1 ? "" : std::to_string(power)); };
    if (d.force_power == 0) return to_the(d.length_power);
    return d.length_power == 0 ? force : force + "/" + to_the(-d.length_power);
}

Eigen::VectorXd numbers_inside(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& numbers,
                               const std::optional<job::Job>& job)
{
    if (!job) return numbers;
    Eigen::Matrix3Xd flat = points;
    flat.row(2).setZero(); // the region of a point with undefined z is defined, too
    const std::vector<job::Region> region = job::classify_regions(*job, flat);
    std::vector<double> chosen;
    for (std::size_t i = 0; i < region.size(); ++i)
        if (region[i] == job::Region::inside) chosen.push_back(numbers[Index(i)]);
    return Eigen::Map<Eigen::VectorXd>(chosen.data(), Index(chosen.size()));
}

Eigen::VectorXd values_of(const cloud::Cloud& cloud, const std::string& field, const units::Units& units)
{
    if (field == "z") return cloud.xyz.row(2) / units.mm();
    return cloud::field(cloud, field) / units::base_unit_factor(units, cloud::field_dimension(field));
}

Eigen::VectorXd packed_colours(const cloud::Cloud& cloud)
{
    const auto found = std::ranges::find(cloud.fields, "rgb", &cloud::Field::name);
    if (found == cloud.fields.end() || found->size != 4 || found->count != 1)
        throw core::InputError("there is no field 'rgb' of colours as PCL packs them");
    Eigen::VectorXd packed(cloud.size());
    for (Index i = 0; i < cloud.size(); ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, found->bytes.data() + 4 * i, sizeof bits);
        packed[i] = bits & 0xffffffU;
    }
    return packed;
}

Rgb unpacked(double colour)
{
    const auto bits = static_cast<std::uint32_t>(colour);
    return {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
            static_cast<std::uint8_t>(bits)};
}

FieldValues field_values(const cloud::Cloud& cloud, const std::string& field, const units::Units& units,
                         const std::optional<job::Job>& job, const ScaleOptions& options)
{
    FieldValues found;
    if (field == "rgb") {
        found.numbers = packed_colours(cloud);
        found.scale.packed = true;
        return found;
    }
    found.numbers = values_of(cloud, field, units);
    const Eigen::VectorXd chosen = numbers_inside(cloud.xyz, found.numbers, job);
    found.scale = field == "class" ? class_scale(cloud, chosen, options.palette) : scale_for(field, chosen, options);
    return found;
}

} // namespace fettle::draw
