#include "belt/patch_surface.h"

#include "core/error.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fettle::belt {
namespace {

// Number of surfels at which the speed of the parameters (mm per unit of u or v) is sampled, and number of equal
// intervals of each parameter for which its maximum is taken.
constexpr Eigen::Index kSpeedSamples = 10000;
constexpr int kIntervals = 64;
// Relative: the disc of a surfel just reaches the corners of its lattice cell.
constexpr double kRadiusTolerance = 0.01;

} // namespace

PatchSurface::PatchSurface(const Surfels& surfels, int patch, bool on_stock) : patch_(patch)
{
    std::vector<Eigen::Index> own;
    for (Eigen::Index i = 0; i < surfels.size(); ++i)
        if (surfels.patch[i] == patch_ && (!on_stock || !std::isnan(surfels.displacement[i]))) own.push_back(i);
    if (own.empty()) throw PatchTooSmall("no surfels on patch " + std::to_string(patch_));
    surfels_.position = surfels.position(Eigen::all, own);
    surfels_.normal = surfels.normal(Eigen::all, own);
    surfels_.radius = surfels.radius(own);
    surfels_.uv = surfels.uv(Eigen::all, own);
    surfels_.patch = surfels.patch(own);
    surfels_.displacement = surfels.displacement(own);
    if (!on_stock) surfels_.displacement.setZero();
    max_radius_ = surfels_.radius.maxCoeff();
    measure_lengths();
    Eigen::Matrix2Xd lengths(2, surfels_.size());
    for (Eigen::Index i = 0; i < surfels_.size(); ++i)
        lengths.col(i) << length(0, surfels_.uv(0, i)), length(1, surfels_.uv(1, i));
    neighbours_.emplace(lengths);
}

std::optional<LocalFit> PatchSurface::fit_at(const Eigen::Vector2d& lengths) const
{
    const std::vector<Eigen::Index> near = neighbours_->nearest(lengths, kFitCandidates);
    const Eigen::Vector2d uv(parameter(0, lengths.x()), parameter(1, lengths.y()));
    const std::optional<LocalFit> fit = local_fit(surfels_, patch_, uv, near);
    if (!fit) return std::nullopt;
    const bool is_on_patch = std::any_of(near.begin(), near.end(), [&](Eigen::Index i) {
        return (surfels_.position.col(i) - fit->P).norm() <= max_radius_ * (1 + kRadiusTolerance);
    });
    return is_on_patch ? fit : std::nullopt;
}

double PatchSurface::parameter(int axis, double length) const
{
    const Eigen::VectorXd& lengths = lengths_[axis];
    int i = 0;
    while (i + 1 < kIntervals && lengths[i + 1] < length) ++i;
    const double fraction = (length - lengths[i]) / (lengths[i + 1] - lengths[i]);
    return uv_box_.min()[axis] + uv_box_.sizes()[axis] * (i + std::clamp(fraction, 0.0, 1.0)) / kIntervals;
}

double PatchSurface::length(int axis, double parameter) const
{
    const double t = (parameter - uv_box_.min()[axis]) / uv_box_.sizes()[axis] * kIntervals;
    const int i = std::clamp(static_cast<int>(t), 0, kIntervals - 1);
    return lengths_[axis][i] + (t - i) * (lengths_[axis][i + 1] - lengths_[axis][i]);
}

/// Maximum speeds of u and v in their intervals, 2 x kIntervals; 0 where no surfel was sampled.
Eigen::Matrix2Xd PatchSurface::max_speeds() const
{
    const geometry::PointIndex<3> neighbours(surfels_.position);
    const Eigen::Index step = std::max<Eigen::Index>(1, surfels_.size() / kSpeedSamples);
    Eigen::Matrix2Xd speeds = Eigen::Matrix2Xd::Zero(2, kIntervals);
    for (Eigen::Index i = 0; i < surfels_.size(); i += step) {
        const auto fit = local_fit(surfels_, patch_, surfels_.uv.col(i),
                                   neighbours.nearest(surfels_.position.col(i), kFitCandidates));
        if (!fit) continue;
        const Eigen::Vector2d speed(fit->P_u.norm(), fit->P_v.norm());
        const Eigen::Vector2d fraction = (surfels_.uv.col(i) - uv_box_.min()).cwiseQuotient(uv_box_.sizes());
        for (int axis = 0; axis < 2; ++axis) {
            double& max = speeds(axis, std::clamp(static_cast<int>(fraction[axis] * kIntervals), 0, kIntervals - 1));
            max = std::max(max, speed[axis]);
        }
    }
    return speeds;
}

/// Tabulates lengths over the parameters from the maximum speeds in their intervals.
void PatchSurface::measure_lengths()
{
    uv_box_ = geometry::bounding_box(surfels_.uv);
    const Eigen::Matrix2Xd speeds = max_speeds();
    const Eigen::Vector2d overall = speeds.rowwise().maxCoeff();
    if (!(overall.minCoeff() > 0))
        throw PatchTooSmall("too few surfels on patch " + std::to_string(patch_) + " for a path");
    for (int axis = 0; axis < 2; ++axis) {
        lengths_[axis] = Eigen::VectorXd::Zero(kIntervals + 1);
        for (int k = 0; k < kIntervals; ++k) {
            // Between samples the maximum may be that of a neighbouring interval. Without samples in these the overall
            // maximum is used.
            const int from = std::max(k - 1, 0), to = std::min(k + 1, kIntervals - 1);
            const double found = speeds.row(axis).segment(from, to - from + 1).maxCoeff();
            const double speed = found > 0 ? found : overall[axis];
            lengths_[axis][k + 1] = lengths_[axis][k] + speed * uv_box_.sizes()[axis] / kIntervals;
        }
    }
}

} // namespace fettle::belt
