#include "reconstruct/ordered.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <array>

namespace fettle::reconstruct {
namespace {

double median_of(std::vector<double> lengths) { return lengths.empty() ? 0 : geometry::median(lengths); }

/// The points of a profile that advance along its direction.
std::vector<int> advancing(const Eigen::Matrix3Xd& xyz, const cloud::Profiles& profiles, std::size_t profile)
{
    std::vector<int> points;
    for (Eigen::Index i = profiles.first[profile]; i < profiles.first[profile + 1]; ++i)
        if (points.empty() || profiles.direction.dot(xyz.col(i) - xyz.col(points.back())) > 0)
            points.push_back(static_cast<int>(i));
    return points;
}

} // namespace

OrderedTriangles grid_triangles(const Eigen::Matrix3Xd& xyz, Eigen::Index width)
{
    OrderedTriangles result;
    std::array<std::vector<double>, 2> lengths; // along rows, along columns
    const auto is_point = [&](Eigen::Index i) { return xyz.col(i).allFinite(); };
    const auto distance = [&](Eigen::Index a, Eigen::Index b) { return (xyz.col(a) - xyz.col(b)).norm(); };
    for (Eigen::Index first = 0; first + width < xyz.cols(); first += width)
        for (Eigen::Index i = first; i < first + width; ++i) {
            if (is_point(i) && is_point(i + width)) lengths[1].push_back(distance(i, i + width));
            if (i + 1 == first + width) break;
            if (is_point(i) && is_point(i + 1)) lengths[0].push_back(distance(i, i + 1));
            const std::array<Eigen::Index, 4> around = {i, i + 1, i + width + 1, i + width}; // counter-clockwise
            std::vector<int> corners;
            for (const Eigen::Index corner : around)
                if (is_point(corner)) corners.push_back(static_cast<int>(corner));
            if (corners.size() == 3) result.triangles.emplace_back(corners[0], corners[1], corners[2]);
            if (corners.size() != 4) continue;
            const bool is_first_shorter = distance(around[0], around[2]) <= distance(around[1], around[3]);
            const std::size_t k = is_first_shorter ? 0 : 1;
            result.triangles.emplace_back(corners[k], corners[k + 1], corners[k + 2]);
            result.triangles.emplace_back(corners[k + 2], corners[(k + 3) % 4], corners[k]);
        }
    result.spacing = std::max(median_of(lengths[0]), median_of(lengths[1]));
    return result;
}

OrderedTriangles profile_triangles(const Eigen::Matrix3Xd& xyz, const cloud::Profiles& profiles)
{
    OrderedTriangles result;
    std::vector<double> along, across;
    const auto position = [&](int i) { return profiles.direction.dot(xyz.col(i)); };
    std::vector<int> before = advancing(xyz, profiles, 0);
    for (std::size_t p = 1; p + 1 < profiles.first.size(); ++p) {
        const std::vector<int> after = advancing(xyz, profiles, p);
        for (std::size_t k = 1; k < after.size(); ++k)
            along.push_back((xyz.col(after[k]) - xyz.col(after[k - 1])).norm());
        std::size_t a = 0, b = 0;
        while (a + 1 < before.size() || b + 1 < after.size()) {
            // The profile whose next point lies farther back goes on.
            const bool first_goes_on =
                b + 1 == after.size() || (a + 1 < before.size() && position(before[a + 1]) < position(after[b + 1]));
            if (first_goes_on) {
                result.triangles.emplace_back(before[a], before[a + 1], after[b]);
                ++a;
            } else {
                result.triangles.emplace_back(before[a], after[b + 1], after[b]);
                ++b;
            }
            across.push_back((xyz.col(before[a]) - xyz.col(after[b])).norm());
        }
        before = after;
    }
    result.spacing = std::max(median_of(std::move(along)), median_of(std::move(across)));
    return result;
}

} // namespace fettle::reconstruct
