#include "geometry/spacing.h"

#include "geometry/point_index.h"
#include "geometry/quantiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle::geometry {

double point_spacing(const Eigen::Matrix3Xd& xyz)
{
    constexpr Eigen::Index kSamples = 1000,
                           kNeighbour = 8; // of so many points; within the circle through the neighbour
    const PointIndex<3> index(xyz);
    const Eigen::Index count = std::min(kSamples, xyz.cols());
    std::vector<double> spacings(count);
    tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index k) {
        const Eigen::Vector3d p = xyz.col(k * xyz.cols() / count);
        const double radius = (xyz.col(index.nearest(p, 1 + kNeighbour).back()) - p).norm();
        spacings[k] = radius * std::sqrt(std::numbers::pi / kNeighbour);
    });
    return median(spacings);
}

} // namespace fettle::geometry
