#include "core/direction.h"

#include "core/error.h"
#include "core/text.h"

#include <Eigen/Geometry>

#include <cmath>
#include <optional>
#include <sstream>

namespace fettle::core {

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

Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    const Eigen::Vector3d a = from.stableNormalized(), b = to.stableNormalized();
    // Half a turn about a, then half a turn about the bisector a + b. For nearly opposite vectors the bisector is
    // mostly rounding error and is made perpendicular to b - a; for opposite ones any perpendicular to a will do.
    constexpr double kMinBisectorLength = 1e-12;
    const Eigen::Vector3d difference = b - a;
    Eigen::Vector3d bisector = a + b;
    if (a.dot(b) < 0) bisector -= difference * (difference.dot(bisector) / difference.squaredNorm());
    bisector = bisector.norm() > kMinBisectorLength ? bisector.normalized() : a.unitOrthogonal();
    const auto half_turn = [](const Eigen::Vector3d& axis) -> Eigen::Matrix3d {
        return 2 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
    };
    return half_turn(bisector) * half_turn(a);
}

} // namespace fettle::core
