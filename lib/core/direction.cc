#include "core/direction.h"

#include "core/error.h"
#include "core/text.h"

#include <Eigen/Geometry>

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

Eigen::Matrix3d turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    const Eigen::Vector3d a = from.stableNormalized(), b = to.stableNormalized();
    // Half a turn about `a`, then half a turn about the middle between both. Of nearly opposite ones rounding leaves
    // little else than that the middle is at right angles to b - a; of opposite ones any will do.
    constexpr double kOpposite = 1e-12;
    const Eigen::Vector3d apart = b - a;
    Eigen::Vector3d middle = a + b;
    if (a.dot(b) < 0) middle -= apart * (apart.dot(middle) / apart.squaredNorm());
    middle = middle.norm() > kOpposite ? middle.normalized() : a.unitOrthogonal();
    const auto half_turn = [](const Eigen::Vector3d& axis) -> Eigen::Matrix3d {
        return 2 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
    };
    return half_turn(middle) * half_turn(a);
}

} // namespace fettle
