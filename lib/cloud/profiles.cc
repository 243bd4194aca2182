#include "cloud/profiles.h"

#include "core/decompositions.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::cloud {
namespace {

constexpr double kMinReturnSteps = 10;     // of a return to the begin of the next profile, in median steps
constexpr double kMaxStepSteps = 5;        // longer steps cross gaps, and say nothing about the direction
constexpr Eigen::Index kMinProfiles = 3;   // two are no surface that is wider than a gap
constexpr Eigen::Index kMinMeanPoints = 5; // points in any other order seldom advance as often
constexpr double kMaxSideStep = 0.05; // of neighbouring points across their profile; rows of cubes have 0.08 to 0.2
constexpr double kMaxBackwardShare =
    0.2; // of all steps: reflections, noise, overhangs; half of them in any other order

/// The direction of the short steps, unit; the points advance along it.
Eigen::Vector3d main_direction(const Eigen::Matrix3Xd& steps, double max_length)
{
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& step : steps.colwise())
        if (step.norm() <= max_length) {
            scatter += step * step.transpose();
            sum += step;
        }
    const Eigen::Vector3d direction = core::symmetric_eigen<3>(scatter).vectors.col(2);
    return direction.dot(sum) < 0 ? Eigen::Vector3d(-direction) : direction;
}

/// Points of a profile that advance, and how far each has come along the direction, mm.
struct Advance {
    std::vector<Eigen::Index> points;
    std::vector<double> at;
};

Advance advance_of(const Eigen::Matrix3Xd& xyz, const Profiles& profiles, std::size_t profile)
{
    Advance advance;
    for (Eigen::Index i = profiles.first[profile]; i < profiles.first[profile + 1]; ++i) {
        const double at = profiles.direction.dot(xyz.col(i));
        if (!advance.at.empty() && !(at > advance.at.back())) continue;
        advance.points.push_back(i);
        advance.at.push_back(at);
    }
    return advance;
}

/// The point of a profile abreast of a place along the direction; nothing beyond its ends and in its gaps.
std::optional<Eigen::Vector3d> point_abreast(const Eigen::Matrix3Xd& xyz, const Advance& profile, double at,
                                             double max_gap)
{
    const auto next = std::ranges::upper_bound(profile.at, at);
    if (next == profile.at.begin() || next == profile.at.end()) return std::nullopt;
    const auto k = next - profile.at.begin();
    const double gap = profile.at[k] - profile.at[k - 1];
    if (gap > max_gap) return std::nullopt;
    const double share = (at - profile.at[k - 1]) / gap;
    return (1 - share) * xyz.col(profile.points[k - 1]) + share * xyz.col(profile.points[k]);
}

/// Median of how far neighbouring points of a profile lie apart across it, in distances from the profile before to the
/// one after. A light plane and a raster's row leave nothing; rows of cubes of a grid, whose points lie anywhere in
/// their cubes, are as rough as they are wide.
double median_side_step(const Eigen::Matrix3Xd& xyz, const Profiles& profiles, double max_gap)
{
    std::vector<double> side_steps;
    Advance before = advance_of(xyz, profiles, 0), current = advance_of(xyz, profiles, 1);
    for (std::size_t p = 2; p + 1 < profiles.first.size(); ++p) {
        Advance after = advance_of(xyz, profiles, p);
        std::optional<double> last;
        for (std::size_t k = 0; k < current.points.size(); ++k) {
            const auto from = point_abreast(xyz, before, current.at[k], max_gap);
            const auto to = point_abreast(xyz, after, current.at[k], max_gap);
            std::optional<double> share;
            if (from && to && *from != *to)
                share = (xyz.col(current.points[k]) - *from).dot(*to - *from) / (*to - *from).squaredNorm();
            if (share && last) side_steps.push_back(std::abs(*share - *last));
            last = share;
        }
        before = std::move(current);
        current = std::move(after);
    }
    return side_steps.empty() ? 0 : geometry::median(side_steps);
}

} // namespace

std::optional<Profiles> find_profiles(const Eigen::Matrix3Xd& xyz)
{
    if (xyz.cols() < kMinProfiles * kMinMeanPoints) return std::nullopt;
    const Eigen::Matrix3Xd steps = xyz.rightCols(xyz.cols() - 1) - xyz.leftCols(xyz.cols() - 1);
    const double median = geometry::median_absolute(steps.colwise().norm());
    if (!(median > 0)) return std::nullopt;
    Profiles profiles{{0}, main_direction(steps, kMaxStepSteps * median)};
    Eigen::Index backward = 0;
    for (Eigen::Index i = 0; i < steps.cols(); ++i) {
        const double advance = profiles.direction.dot(steps.col(i));
        if (advance < -kMinReturnSteps * median)
            profiles.first.push_back(i + 1);
        else if (advance < 0)
            ++backward;
    }
    const auto count = static_cast<Eigen::Index>(profiles.first.size());
    profiles.first.push_back(xyz.cols());
    if (count < kMinProfiles || xyz.cols() < kMinMeanPoints * count) return std::nullopt;
    if (static_cast<double>(backward) > kMaxBackwardShare * static_cast<double>(xyz.cols())) return std::nullopt;
    if (median_side_step(xyz, profiles, kMaxStepSteps * median) > kMaxSideStep) return std::nullopt;
    return profiles;
}

} // namespace fettle::cloud
