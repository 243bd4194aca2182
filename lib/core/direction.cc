#include "core/direction.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>
#include <optional>
#include <sstream>

namespace fettle {

Eigen::Vector3d parse_direction(const std::string& text, const std::string& source)
{
    const auto refuse = [&] { throw InputError(source, "expected three numbers x,y,z, got '" + text + "'"); };
    Eigen::Vector3d direction;
    std::istringstream parts(text + ",");
    int read = 0;
    for (std::string part; std::getline(parts, part, ','); ++read) {
        const std::optional<double> number = parse_number(part);
        if (read >= 3 || !number || !std::isfinite(*number)) refuse();
        direction[read] = *number;
    }
    if (read != 3) refuse();
    const double length = direction.stableNorm();
    if (!(length > 0)) throw InputError(source, "has no length: '" + text + "'");
    return direction / length;
}

} // namespace fettle
