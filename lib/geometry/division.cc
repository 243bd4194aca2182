#include "geometry/division.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle::geometry {

Eigen::Matrix2Xd division_points(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double max_length)
{
    if (!(max_length > 0))
        throw core::InputError("a segment cannot be divided into pieces of length " + core::to_text(max_length));
    const Eigen::Vector2d along = to - from;
    const double pieces = std::ceil(along.norm() / max_length);
    Eigen::Matrix2Xd points(2, Eigen::Index(std::max(pieces - 1, 0.0)));
    for (Eigen::Index i = 0; i < points.cols(); ++i) points.col(i) = from + double(i + 1) / pieces * along;
    return points;
}

} // namespace fettle::geometry
