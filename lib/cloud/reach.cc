#include "cloud/reach.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>

namespace fettle {

void check_reach(const Eigen::Matrix3Xd& xyz, const std::string& source)
{
    constexpr double kFarthest = 1e12; // mm: the Earth has 1.3e10, as surveyors' coordinates may say
    if (!(xyz.array().abs() > kFarthest).any()) return;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        for (const double coordinate : xyz.col(i))
            if (std::isfinite(coordinate) && std::abs(coordinate) > kFarthest)
                throw InputError(source, "point " + std::to_string(i) +
                                             ": no part reaches that far: " + to_short_text(coordinate) + " mm");
}

} // namespace fettle
