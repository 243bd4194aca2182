#include "find/profile_order.h"

#include "cloud/profiles.h"
#include "geometry/quantiles.h"
#include "reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle::find {
namespace {

using Eigen::Index;

// Above this ratio of the two spacings, anomalies of a few profiles' width would have too few cells.
constexpr double kMinAnisotropy = 3;
constexpr Index kSampledProfiles = 100;

/// Distance between profiles over that between the points of each, as medians of some profiles.
double anisotropy(const Eigen::Matrix3Xd& xyz, const cloud::Profiles& profiles)
{
    std::vector<double> along, across;
    const auto last = Index(profiles.first.size()) - 2; // profile
    const Index step = std::max<Index>(1, last / kSampledProfiles);
    const auto first_of = [&](Index k) { return profiles.first[std::size_t(k)]; };
    for (Index k = 0; k < last; k += step) {
        const Index middle = (first_of(k) + first_of(k + 1)) / 2;
        if (middle + 1 < first_of(k + 1)) along.push_back((xyz.col(middle + 1) - xyz.col(middle)).norm());
        double nearest = std::numeric_limits<double>::infinity();
        for (Index i = first_of(k + 1); i < first_of(k + 2); ++i)
            nearest = std::min(nearest, (xyz.col(i) - xyz.col(middle)).squaredNorm());
        across.push_back(std::sqrt(nearest));
    }
    return along.empty() ? 1 : geometry::median(across) / geometry::median(along);
}

const std::string kIndexField = "index of the point in its profiler's list"; // no file has such a field

} // namespace

bool join_profiles(mesh::CloudMesh& part)
{
    if (part.is_mesh() || !part.points.xyz.allFinite()) return false;
    const std::optional<cloud::Profiles> profiles = cloud::find_profiles(part.points.xyz);
    if (!profiles || anisotropy(part.points.xyz, *profiles) < kMinAnisotropy) return false;
    cloud::Cloud numbered = part.points;
    const Index count = part.points.size();
    cloud::set_field(numbered, kIndexField, Eigen::VectorXd::LinSpaced(count, 0, double(count - 1)));
    const mesh::CloudMesh joined = reconstruct::reconstruct(numbered, {}).mesh;
    const Eigen::VectorXd index = cloud::field(joined.points, kIndexField);
    part.triangles = joined.triangles.unaryExpr([&](auto corner) { return decltype(corner)(index[Index(corner)]); });
    return true;
}

} // namespace fettle::find
