#include "compare/weld.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <compare>
#include <limits>
#include <numbers>
#include <numeric>

namespace fettle {

namespace {

// Vertices of neighbouring facets that a program rounded to float on its own may differ in their last bits: this many
// units in the last place.
constexpr double kLastBits = 8;

struct Place {
    double along = 0;
    std::array<double, 3> xyz{};
    std::int32_t index = 0;

    auto operator<=>(const Place&) const = default;
};

// Sorted along a direction in which no usual grid has ties, near vertices are neighbours in the list, equal ones
// follow each other, the lowest index first. The index is that of the candidate.
std::vector<Place> sorted(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates)
{
    const Eigen::Vector3d odd = Eigen::Vector3d(1, std::numbers::phi, std::numbers::pi).normalized();
    std::vector<Place> places;
    places.reserve(candidates.size());
    for (const std::int32_t candidate : candidates) {
        const Eigen::Vector3d v = vertices.col(candidate);
        places.push_back({odd.dot(v), {v.x(), v.y(), v.z()}, static_cast<std::int32_t>(places.size())});
    }
    tbb::parallel_sort(places);
    return places;
}

} // namespace

double float_rounding(double coordinate)
{
    return kLastBits * static_cast<double>(std::numeric_limits<float>::epsilon()) * coordinate;
}

double typical_coordinate(const Eigen::Matrix3Xd& vertices)
{
    std::vector<double> largest;
    for (const auto& vertex : vertices.colwise())
        if (vertex.allFinite()) largest.push_back(vertex.cwiseAbs().maxCoeff());
    if (largest.empty()) return 0;
    const auto middle = largest.begin() + static_cast<std::ptrdiff_t>(largest.size() / 2);
    std::nth_element(largest.begin(), middle, largest.end());
    return *middle;
}

std::vector<std::int32_t> weld(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates,
                               const std::function<double(const Eigen::Vector3d&)>& tolerance)
{
    std::vector<std::int32_t> lowest(candidates.size());
    std::iota(lowest.begin(), lowest.end(), 0);
    const auto root = [&](std::int32_t c) {
        while (lowest[static_cast<std::size_t>(c)] != c) c = lowest[static_cast<std::size_t>(c)];
        return c;
    };
    std::vector<Place> places; // one for equal vertices, which may be many
    for (const Place& place : sorted(vertices, candidates))
        if (places.empty() || places.back().xyz != place.xyz)
            places.push_back(place);
        else
            lowest[static_cast<std::size_t>(place.index)] = places.back().index;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Eigen::Vector3d here = Eigen::Vector3d::Map(places[i].xyz.data());
        const double near = tolerance(here);
        for (std::size_t j = i + 1; j < places.size() && places[j].along - places[i].along <= near; ++j) {
            if ((Eigen::Vector3d::Map(places[j].xyz.data()) - here).norm() > near) continue;
            const auto [low, high] = std::minmax({root(places[i].index), root(places[j].index)});
            lowest[static_cast<std::size_t>(high)] = low;
        }
    }
    std::vector<std::int32_t> to(lowest.size());
    for (std::size_t c = 0; c < to.size(); ++c)
        to[c] = candidates[static_cast<std::size_t>(root(static_cast<std::int32_t>(c)))];
    return to;
}

} // namespace fettle
