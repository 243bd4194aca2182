#include "clean/outliers.h"

#include "clean/neighbour_distances.h"
#include "core/error.h"
#include "geometry/sum.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fettle::clean {
namespace {

std::vector<char> find_outliers(const Eigen::Matrix3Xd& xyz, const StatisticalFilter& filter)
{
    std::vector<float> mean_distances(xyz.cols()); // PCL's precision
    for_each_neighbourhood(xyz, filter.neighbours, [&](Eigen::Index i, std::span<const float> squared) {
        double sum = 0;
        for (const float square : squared) sum += std::sqrt(square);
        mean_distances[i] = static_cast<float>(sum / static_cast<double>(squared.size()));
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
    for_each_neighbourhood(xyz, filter.neighbours, [&](Eigen::Index i, std::span<const float> squared) {
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
