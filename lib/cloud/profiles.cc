#include "cloud/profiles.h"

#include "core/decompositions.h"
#include "geometry/quantiles.h"

namespace fettle::cloud {
namespace {

constexpr double kMinReturnSteps = 10;     // of a return to the begin of the next profile, in median steps
constexpr double kMaxStepSteps = 5;        // longer steps cross gaps, and say nothing about the direction
constexpr Eigen::Index kMinProfiles = 3;   // two are no surface that is wider than a gap
constexpr Eigen::Index kMinMeanPoints = 5; // points in any other order seldom advance as often
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
    return profiles;
}

} // namespace fettle::cloud
