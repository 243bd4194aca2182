#include "find/earlier.h"

#include "core/error.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace fettle::find {
namespace {

using Eigen::Index;

// A find belongs to a job if this share of its points lies within B; B encloses it if the second share does.
constexpr double kMatchShare = 0.5, kCoveredShare = 0.995;

/// An earlier job on today's part.
struct PlacedJob {
    const EarlierJob* earlier;
    Eigen::Isometry3d T_job_part;
    double low, high; // range of z in which its anomaly can lie, mm
};

PlacedJob placed_job(const EarlierJob& earlier, const Eigen::Isometry3d& T_earlier_part)
{
    const Eigen::Matrix3Xd& corners = earlier.job.anomaly;
    double low = 0, high = 0;
    for (const double z : corners.row(2))
        if (std::isfinite(z)) low = std::min(low, z), high = std::max(high, z);
    const double reach =
        (corners.topRows<2>().rowwise().maxCoeff() - corners.topRows<2>().rowwise().minCoeff()).norm() / 2;
    const Eigen::Isometry3d T_job_earlier =
        earlier.job.T_part_job ? earlier.job.T_part_job->inverse() : Eigen::Isometry3d::Identity();
    return {&earlier, T_job_earlier * T_earlier_part, low - reach, high + reach};
}

/// Share of a find's points within a job's B.
double share_within(const FoundAnomaly& found, const mesh::CloudMesh& part, const PlacedJob& placed)
{
    const Eigen::Matrix2Xd boundary = placed.earlier->job.anomaly.topRows<2>();
    Index within = 0;
    for (const Index i : found.points) {
        const Eigen::Vector3d p = placed.T_job_part * Eigen::Vector3d(part.points.xyz.col(i));
        within += p.z() >= placed.low && p.z() <= placed.high && job::contains(boundary, p.head<2>());
    }
    return found.points.empty() ? 0 : double(within) / double(found.points.size());
}

/// Adds the points of another find of the same anomaly.
void absorb(FoundAnomaly& one, const FoundAnomaly& other)
{
    std::map<Index, double> heights;
    for (const FoundAnomaly* found : {static_cast<const FoundAnomaly*>(&one), &other})
        for (std::size_t k = 0; k < found->points.size(); ++k) heights[found->points[k]] = found->heights[Index(k)];
    one.points.clear();
    one.heights.resize(Index(heights.size()));
    for (const auto& [point, height] : heights) {
        one.heights[Index(one.points.size())] = height;
        one.points.push_back(point);
    }
    one.height = std::max(one.height, other.height);
    one.significance = std::max(one.significance, other.significance);
    one.area += other.area;
    one.volume += other.volume;
}

/// Replaces frame, B and S of a find by those of a job, unless that has no S, as a plane's job may.
void adopt_outlines(FoundAnomaly& found, const PlacedJob& placed)
{
    if (placed.earlier->job.sampling.cols() == 0) return;
    found.T_anomaly_part = placed.T_job_part;
    found.boundary = placed.earlier->job.anomaly.topRows<2>();
    found.sampling = placed.earlier->job.sampling.topRows<2>();
}

} // namespace

std::vector<EarlierJob> read_earlier_jobs(const std::string& folder)
{
    std::error_code error;
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".json") files.push_back(folder + "/" + entry.path().filename().string());
    if (error) throw core::InputError(folder, "cannot be read: " + error.message());
    if (files.empty()) throw core::InputError(folder, "has no job");
    std::ranges::sort(files);
    std::vector<EarlierJob> jobs;
    for (const std::string& file : files) jobs.push_back({file, job::read_job(file)});
    return jobs;
}

void match_earlier(FindResult& result, const mesh::CloudMesh& part, const std::vector<EarlierJob>& jobs,
                   const Eigen::Isometry3d& T_earlier_part, double min_probability)
{
    std::vector<FoundAnomaly> rows;
    std::vector<char> is_matched(result.anomalies.size(), 0);
    for (const EarlierJob& earlier : jobs) {
        const PlacedJob placed = placed_job(earlier, T_earlier_part);
        std::vector<FoundAnomaly*> within, beyond;
        for (std::size_t k = 0; k < result.anomalies.size(); ++k) {
            const double share = is_matched[k] ? 0 : share_within(result.anomalies[k], part, placed);
            if (share < kMatchShare) continue;
            is_matched[k] = 1;
            (share >= kCoveredShare ? within : beyond).push_back(&result.anomalies[k]);
        }
        if (within.empty() && beyond.empty()) result.absent.push_back(earlier.file);
        for (std::size_t k = 1; k < within.size(); ++k) absorb(*within[0], *within[k]);
        if (!within.empty()) {
            adopt_outlines(*within[0], placed);
            within.resize(1);
        }
        for (FoundAnomaly* found : beyond) within.push_back(found);
        for (FoundAnomaly* found : within) {
            found->doubt.clear();
            found->like = earlier.file;
            rows.push_back(std::move(*found));
        }
    }
    for (std::size_t k = 0; k < result.anomalies.size(); ++k)
        if (!is_matched[k] && result.anomalies[k].probability >= min_probability)
            rows.push_back(std::move(result.anomalies[k]));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].number = int(k) + 1;
    result.anomalies = std::move(rows);
}

} // namespace fettle::find
