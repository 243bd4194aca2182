#include "clean/outliers.h"

#include "cloud/pcl.h"
#include "core/error.h"
#include "geometry/bounding_box.h"
#include "geometry/sum.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace fettle::clean {
namespace {

/// Calls `use(i, squared)` with the squared distances of each point to itself and its `count` nearest others,
/// ascending; in parallel.
template <typename Use>
void for_each_neighbourhood(const Eigen::Matrix3Xd& xyz, int count, const Use& use)
{
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(cloud::to_pcl(xyz, geometry::bounding_box(xyz).center()));
    const auto& points = *tree.getInputCloud();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          pcl::Indices indices;
                          std::vector<float> squared;
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              tree.nearestKSearch(points[i], count + 1, indices, squared);
                              use(i, squared);
                          }
                      });
}

std::vector<char> find_outliers(const Eigen::Matrix3Xd& xyz, const StatisticalFilter& filter)
{
    std::vector<float> mean_distances(xyz.cols()); // PCL's precision
    for_each_neighbourhood(xyz, filter.neighbours, [&](std::size_t i, const std::vector<float>& squared) {
        double sum = 0;
        for (std::size_t k = 1; k < squared.size(); ++k) sum += std::sqrt(squared[k]);
        mean_distances[i] = static_cast<float>(sum / static_cast<double>(squared.size() - 1));
    });
    geometry::CompensatedSum sum, squares;
    for (const float distance : mean_distances) sum.add(distance);
    const auto count = static_cast<double>(mean_distances.size());
    const double mean = sum.value() / count;
    for (const float distance : mean_distances) squares.add((distance - mean) * (distance - mean));
    const double limit = mean + filter.sigmas * std::sqrt(squares.value() / (count - 1));
    std::vector<char> is_outlier(mean_distances.size());
    std::ranges::transform(mean_distances, is_outlier.begin(), [&](float distance) { return distance > limit; });
    return is_outlier;
}

std::vector<char> find_outliers(const Eigen::Matrix3Xd& xyz, const RadiusFilter& filter)
{
    std::vector<char> is_outlier(xyz.cols());
    for_each_neighbourhood(xyz, filter.neighbours, [&](std::size_t i, const std::vector<float>& squared) {
        is_outlier[i] = !(squared.back() <= filter.radius * filter.radius);
    });
    return is_outlier;
}

} // namespace

std::vector<char> find_outliers(const Eigen::Matrix3Xd& xyz, const OutlierFilter& filter)
{
    const int neighbours = std::visit([](const auto& f) { return f.neighbours; }, filter);
    if (xyz.cols() <= neighbours)
        throw core::InputError(std::to_string(neighbours) + " neighbours of each point are asked for, among " +
                               std::to_string(xyz.cols()) + " points");
    return std::visit([&](const auto& f) { return find_outliers(xyz, f); }, filter);
}

} // namespace fettle::clean
