#include "cloud/reach.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>

namespace fettle::cloud {

void check_coordinate_range(const Eigen::Matrix3Xd& xyz, const std::string& source)
{
    constexpr double kMaxCoordinate = 1e12; // mm; surveyors' coordinates are at most the size of the Earth, 1.3e10
    if (!(xyz.array().abs() > kMaxCoordinate).any()) return;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        for (const double coordinate : xyz.col(i))
            if (std::isfinite(coordinate) && std::abs(coordinate) > kMaxCoordinate)
                throw core::InputError(source, "point " + std::to_string(i) + ": no part reaches that far: " +
                                                   core::to_short_text(coordinate) + " mm");
}

} // namespace fettle::cloud
