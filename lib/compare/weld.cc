#include "compare/weld.h"

#include "geometry/quantiles.h"
#include "geometry/union_find.h"

#include <tbb/parallel_sort.h>

#include <array>
#include <compare>
#include <limits>
#include <numbers>

namespace fettle::compare {

namespace {

// Equal vertices that a program computed separately for neighbouring facets may differ by this many units in the last
// place of a float.
constexpr double kUnitsInLastPlace = 8;

struct Candidate {
    double projection = 0; ///< onto the sort direction, mm
    std::array<double, 3> xyz{};
    std::int32_t index = 0; ///< among the candidates

    auto operator<=>(const Candidate&) const = default;
};

// Sorts along a direction in which common grids have no ties. Equal vertices follow each other, lowest index first.
std::vector<Candidate> sorted(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates)
{
    const Eigen::Vector3d direction = Eigen::Vector3d(1, std::numbers::phi, std::numbers::pi).normalized();
    std::vector<Candidate> list;
    list.reserve(candidates.size());
    for (const std::int32_t candidate : candidates) {
        const Eigen::Vector3d v = vertices.col(candidate);
        list.push_back({direction.dot(v), {v.x(), v.y(), v.z()}, static_cast<std::int32_t>(list.size())});
    }
    tbb::parallel_sort(list);
    return list;
}

} // namespace

double float_rounding(double coordinate)
{
    return kUnitsInLastPlace * std::numeric_limits<float>::epsilon() * coordinate;
}

double median_coordinate(const Eigen::Matrix3Xd& vertices)
{
    std::vector<double> largest;
    largest.reserve(static_cast<std::size_t>(vertices.cols()));
    for (const auto& vertex : vertices.colwise())
        if (vertex.allFinite()) largest.push_back(vertex.cwiseAbs().maxCoeff());
    if (largest.empty()) return 0;
    return geometry::median(largest);
}

std::vector<std::int32_t> weld(const Eigen::Matrix3Xd& vertices, const std::vector<std::int32_t>& candidates,
                               const std::function<double(const Eigen::Vector3d&)>& tolerance)
{
    geometry::UnionFind sets(candidates.size());
    std::vector<Candidate> distinct; // of equal vertices, which may be many, the first
    for (const Candidate& candidate : sorted(vertices, candidates))
        if (distinct.empty() || distinct.back().xyz != candidate.xyz)
            distinct.push_back(candidate);
        else
            sets.join(candidate.index, distinct.back().index);
    for (std::size_t i = 0; i < distinct.size(); ++i) {
        const Candidate& a = distinct[i];
        const Eigen::Vector3d position = Eigen::Vector3d::Map(a.xyz.data());
        const double radius = tolerance(position);
        for (std::size_t j = i + 1; j < distinct.size() && distinct[j].projection - a.projection <= radius; ++j) {
            if ((Eigen::Vector3d::Map(distinct[j].xyz.data()) - position).norm() > radius) continue;
            sets.join(a.index, distinct[j].index);
        }
    }
    std::vector<std::int32_t> welded(candidates.size());
    for (std::size_t c = 0; c < welded.size(); ++c) welded[c] = candidates[sets.root(c)];
    return welded;
}

} // namespace fettle::compare
