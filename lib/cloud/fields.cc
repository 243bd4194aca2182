#include "cloud/fields.h"

#include "cloud/element.h"
#include "core/range.h"
#include "core/text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

namespace fettle::cloud {

units::Dimension field_dimension(const std::string& name)
{
    for (const char* length :
         {"error", "sigma", "clearance", "radius", "displacement", "removed", "foot_x", "foot_y", "foot_z", "joint7",
          "clearance_between", "gap", "indentation", "deflection", "depth", "retreat", "way", "height", "disagreement"})
        if (name == length) return {1, 0};
    if (name == "area") return {2, 0};
    if (name == "removed_volume") return {3, 0};
    if (name == "force" || name == "peak_force") return {0, 1};
    if (name == "feed") return {1, 0}; // per second: the unit of time is the same everywhere
    if (name == "pressure") return {-2, 1};
    return {};
}

Eigen::VectorXi integer_field(const Cloud& cloud, const std::string& name)
{
    const core::Range integers = core::Range::between(0, std::numeric_limits<int>::max());
    return field(cloud, name).unaryExpr([&integers](double value) {
        return integers.contains(value) && value == std::floor(value) ? static_cast<int>(value) : -1;
    });
}

double element(const Field& field, char type, std::size_t index)
{
    return visit_element(type, field.size, [&](auto zero) {
        return static_cast<double>(load<decltype(zero)>(field.bytes.data() + index * sizeof zero));
    });
}

void append_element(std::string& text, const Field& field, char type, std::size_t index)
{
    visit_element(type, field.size, [&](auto zero) {
        const auto value = load<decltype(zero)>(field.bytes.data() + index * sizeof zero);
        if constexpr (std::is_floating_point_v<decltype(value)>) {
            text += core::to_text(value);
        } else {
            char digits[24]; // enough for 64 bits and a sign
            text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        }
    });
}

std::string text_rows(const Eigen::Matrix3Xf& xyz, const std::vector<Field>& fields, char separator,
                      char (*type_of)(const Field&))
{
    std::string text;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        text += core::to_text(xyz(0, i)) + separator + core::to_text(xyz(1, i)) + separator + core::to_text(xyz(2, i));
        for (const Field& field : fields)
            for (int k = 0; k < field.count; ++k) {
                text += separator;
                append_element(text, field, type_of(field), i * field.count + k);
            }
        text += '\n';
    }
    return text;
}

void scale_field(Field& field, double times, double over)
{
    const std::size_t elements = field.bytes.size() / field.size;
    visit_element(field.type, field.size, [&](auto zero) {
        using From = decltype(zero);
        using To = std::conditional_t<std::is_floating_point_v<From>, From, double>;
        std::vector<std::byte> scaled(elements * sizeof(To));
        for (std::size_t i = 0; i < elements; ++i) {
            const auto value = static_cast<double>(load<From>(field.bytes.data() + i * sizeof(From)));
            store(scaled.data() + i * sizeof(To), static_cast<To>(value * times / over));
        }
        field.bytes = std::move(scaled);
        field.type = 'F';
        field.size = sizeof(To);
    });
}

void to_base_units(Cloud& cloud, const units::Units& units)
{
    if (units == units::Units{}) return;
    cloud.xyz *= units.mm();
    cloud.view_origin *= units.mm();
    for (Field& field : cloud.fields)
        if (const double factor = units::base_unit_factor(units, field_dimension(field.name)); factor != 1)
            scale_field(field, factor);
}

std::vector<Field> to_file_units(std::vector<Field> fields, const units::Units& units)
{
    for (Field& field : fields)
        if (const double factor = units::base_unit_factor(units, field_dimension(field.name)); factor != 1)
            scale_field(field, 1, factor);
    return fields;
}

} // namespace fettle::cloud
