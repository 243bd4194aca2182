#include "merge/fusion.h"

#include "core/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::merge {
namespace {

// Heights within so many standard deviations, or within this share of the reach, are of one surface.
constexpr double kMaxHeightSigmas = 6, kMaxHeightReaches = 0.5;
// A thin wall's other side has another normal.
constexpr double kMinSameSideCosine = 0.5;

/// The points of all registered scans, in the world.
struct AllPoints {
    Eigen::Matrix3Xd xyz, normals;   ///< mm; unit, or zero
    std::vector<std::uint16_t> scan; ///< of each point
};

AllPoints all_points(const Scans& scans, const Registration& registration)
{
    Eigen::Index total = 0;
    for (std::size_t s = 0; s < scans.size(); ++s)
        if (registration.scans[s]) total += scans[s]->xyz.cols();
    AllPoints all{Eigen::Matrix3Xd(3, total), Eigen::Matrix3Xd(3, total), {}};
    all.scan.reserve(total);
    Eigen::Index next = 0;
    for (std::size_t s = 0; s < scans.size(); ++s) {
        if (!registration.scans[s]) continue;
        const Scan& scan = *scans[s];
        const Eigen::Isometry3d& T = registration.scans[s]->T_world_scan;
        all.xyz.middleCols(next, scan.xyz.cols()) = T * scan.xyz;
        const Eigen::Matrix3Xd turned = registration.scans[s]->side * (T.linear() * scan.means.normals);
        for (Eigen::Index i = 0; i < scan.xyz.cols(); ++i) all.normals.col(next++) = turned.col(scan.means.of_point[i]);
        all.scan.insert(all.scan.end(), static_cast<std::size_t>(scan.xyz.cols()), static_cast<std::uint16_t>(s));
    }
    return all;
}

/// In each cube the point nearest to the mean of its points.
std::vector<std::uint32_t> representatives(const Eigen::Matrix3Xd& xyz, double spacing)
{
    const VoxelGrid grid(xyz, spacing);
    std::vector<std::uint32_t> kept(grid.size());
    tbb::parallel_for(std::size_t{0}, grid.size(), [&](std::size_t v) {
        const auto points = grid.points(v);
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (const std::uint32_t i : points) mean += xyz.col(i) / static_cast<double>(points.size());
        kept[v] = *std::ranges::min_element(
            points, {}, [&](std::uint32_t i) { return std::pair((xyz.col(i) - mean).squaredNorm(), i); });
    });
    std::ranges::sort(kept);
    return kept;
}

/// A scan's point nearest to the normal of a place.
struct Sight {
    double sideways_squared = core::kInfinity; ///< distance from the normal, squared, mm²
    double height = 0;                         ///< along it, mm
};

struct MergedPoint {
    Eigen::Vector3d place;
    double scans = 1, disagreement = core::kNaN;
};

MergedPoint merged_point(std::uint32_t point, const AllPoints& all, const VoxelGrid& grid, double reach,
                         const std::vector<double>& noises)
{
    const Eigen::Vector3d p = all.xyz.col(point), n = all.normals.col(point);
    const std::size_t own = all.scan[point];
    MergedPoint merged{p};
    if (n.isZero(0)) return merged;
    std::vector<Sight> sights(noises.size());
    std::vector<double> limits; // of the heights of each scan
    for (const double noise : noises)
        limits.push_back(std::max(kMaxHeightSigmas * std::hypot(noises[own], noise), kMaxHeightReaches * reach));
    sights[own] = {0, 0};
    for (const std::size_t v : grid.around(p))
        for (const std::uint32_t i : grid.points(v)) {
            const std::size_t s = all.scan[i];
            if (s == own) continue;
            const Eigen::Vector3d d = all.xyz.col(i) - p;
            const double height = d.dot(n), sideways = d.squaredNorm() - height * height;
            if (sideways >= std::min(sights[s].sideways_squared, reach * reach)) continue;
            if (std::abs(height) <= limits[s] && all.normals.col(i).dot(n) >= kMinSameSideCosine)
                sights[s] = {sideways, height};
        }
    double weights = 0, sum = 0, count = 0, squares = 0;
    for (std::size_t s = 0; s < sights.size(); ++s) {
        if (sights[s].sideways_squared == core::kInfinity) continue;
        const double weight = 1 / (noises[s] * noises[s]);
        weights += weight;
        sum += weight * sights[s].height;
        ++count;
    }
    const double mean = sum / weights;
    for (const Sight& sight : sights)
        if (sight.sideways_squared < core::kInfinity) squares += std::pow(sight.height - mean, 2);
    merged.place += mean * n;
    merged.scans = count;
    if (count > 1) merged.disagreement = std::sqrt(squares / count);
    return merged;
}

/// Noise of each scan's points, with a lower bound: some files are exact.
std::vector<double> noises_of(const Scans& scans, double spacing)
{
    constexpr double kMinNoiseSpacings = 1e-4;
    std::vector<double> noises;
    for (const auto& scan : scans) noises.push_back(std::max(scan->means.noise, kMinNoiseSpacings * spacing));
    return noises;
}

/// +1 or -1, by which the normals of the world point outwards; 0 if no scan says.
double outer_side(const Scans& scans, const Registration& registration)
{
    for (std::size_t s = 0; s < scans.size(); ++s)
        if (registration.scans[s] && scans[s]->means.outward) return registration.scans[s]->side;
    return 0;
}

} // namespace

cloud::Cloud merge_points(const Scans& scans, const Registration& registration, double spacing, double reach)
{
    const AllPoints all = all_points(scans, registration);
    const std::vector<std::uint32_t> kept = representatives(all.xyz, spacing);
    const VoxelGrid grid(all.xyz, reach);
    const std::vector<double> noises = noises_of(scans, spacing);
    const auto count = static_cast<Eigen::Index>(kept.size());
    cloud::Cloud merged;
    merged.xyz.resize(3, count);
    Eigen::VectorXd seen(count), disagreement(count);
    tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index k) {
        const MergedPoint point = merged_point(kept[k], all, grid, reach, noises);
        merged.xyz.col(k) = point.place;
        seen[k] = point.scans;
        disagreement[k] = point.disagreement;
    });
    if (const double side = outer_side(scans, registration); side != 0)
        cloud::set_normals(merged, side * all.normals(Eigen::all, kept));
    cloud::set_field(merged, "scans", seen);
    cloud::set_field(merged, "disagreement", disagreement);
    return merged;
}

} // namespace fettle::merge
