#include "cloud/fields.h"

#include "cloud/element.h"
#include "core/range.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace fettle {

Dimension field_dimension(const std::string& name)
{
    for (const char* length : {"error", "sigma", "clearance", "radius", "displacement", "removed", "foot_x", "foot_y",
                               "foot_z", "joint7", "clearance_between", "gap", "indentation", "deflection", "depth"})
        if (name == length) return {1, 0};
    if (name == "force" || name == "peak_force") return {0, 1};
    if (name == "feed") return {1, 0}; // per second, which is the unit of time everywhere
    if (name == "pressure") return {-2, 1};
    return {};
}

Eigen::VectorXi whole_numbers(const Cloud& cloud, const std::string& name)
{
    const Range possible = Range::between(0, std::numeric_limits<int>::max());
    return field(cloud, name).unaryExpr([&possible](double value) {
        return possible.contains(value) && value == std::floor(value) ? static_cast<int>(value) : -1;
    });
}

double element(const Field& field, char type, std::size_t index)
{
    return visit_element(type, field.size, [&](auto zero) {
        return static_cast<double>(load<decltype(zero)>(field.bytes.data() + index * sizeof zero));
    });
}

void scale(Field& field, double times, double over)
{
    const std::size_t elements = field.bytes.size() / static_cast<std::size_t>(field.size);
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

} // namespace fettle
