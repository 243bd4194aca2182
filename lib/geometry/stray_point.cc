#include "geometry/stray_point.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::geometry {

namespace {

/// Columns of the finite ones of a sample at equal steps through all points.
std::vector<Eigen::Index> finite_sample(const Eigen::Matrix3Xd& points)
{
    constexpr Eigen::Index kMaxSample =
        1023; // by its median a few percent more points lie to one side than to the other
    const Eigen::Index count = std::min(points.cols(), kMaxSample);
    std::vector<Eigen::Index> sample;
    for (Eigen::Index i = 0; i < count; ++i)
        if (const Eigen::Index column = i * points.cols() / count; points.col(column).allFinite())
            sample.push_back(column);
    return sample;
}

Eigen::Vector3d median_of(const Eigen::Matrix3Xd& points, const std::vector<Eigen::Index>& sample)
{
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    if (sample.empty()) return middle;
    std::vector<double> coordinates(sample.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(sample, coordinates.begin(), [&](Eigen::Index i) { return points(axis, i); });
        middle[axis] = median(coordinates);
    }
    return middle;
}

} // namespace

Eigen::Vector3d sampled_median(const Eigen::Matrix3Xd& points) { return median_of(points, finite_sample(points)); }

std::optional<StrayPoint> find_stray_point(const Eigen::Matrix3Xd& points)
{
    constexpr double kMaxRatio = 1000;
    const std::vector<Eigen::Index> sample = finite_sample(points);
    if (sample.empty()) return std::nullopt;
    const Eigen::Vector3d middle = median_of(points, sample);
    std::vector<double> distances(sample.size());
    std::ranges::transform(sample, distances.begin(), [&](Eigen::Index i) { return (points.col(i) - middle).norm(); });
    const double usual = median(distances);
    double max_squared = 0;
    Eigen::Index farthest = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double squared = (points.col(i) - middle).squaredNorm();
        if (!(squared > max_squared) || !std::isfinite(squared)) continue;
        max_squared = squared;
        farthest = i;
    }
    const double ratio = std::sqrt(max_squared) / usual;
    if (!(usual > 0) || !(ratio > kMaxRatio)) return std::nullopt;
    return StrayPoint{farthest, ratio};
}

} // namespace fettle::geometry
