#include "strategy/force_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle::strategy {
namespace {

/// Target height relative to the height that may remain: as far from grinding too deep as from leaving too much.
constexpr double kForceTargetShare = 0.5;
/// Upper bound of q relative to its estimate: readings are noisy, and the edges of metal lie between points.
constexpr double kMaxQRatio = 1.25;
/// Standard deviations that are added to a learnt coefficient, so that less is ground.
constexpr double kCoefficientSigmas = 2;

} // namespace

ForceControl::ForceControl(const job::Job& job, double max_remaining, const std::optional<KnownRemoval>& known)
    : radius_(job.wheel.radius), preload_(job.force.preload), stiffness_(job.force.stiffness), feed_(job.feed.rate),
      max_force_(job.force.down), target_(kForceTargetShare * max_remaining),
      max_known_q_(
          known ? (1 + kCoefficientSigmas * known->coefficient_sigma) * job.removal_coefficient / job.wheel.width : 0),
      min_q_(job.removal_coefficient / job.wheel.width),
      contact_length_(std::sqrt(2 * job.wheel.radius * max_remaining)),
      max_offset_slope_(max_remaining / contact_length_)
{
}

void ForceControl::begin_pass(const std::vector<double>& along)
{
    if (max_known_q_ > 0) {
        std::vector<PassQ> taught;
        for (std::size_t n = 0; n < along_.size(); ++n)
            if (points_[n].impulse > 0) taught.push_back({along_[n], learned_q(int(n))});
        last_pass_ = std::move(taught);
    }
    along_ = along;
    points_.assign(along.size(), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    interrupt_stroke();
}

void ForceControl::interrupt_stroke()
{
    last_point_ = -1;
    force_offset_ = 0;
}

void ForceControl::record(int point, double remaining, double impulse)
{
    PointState& state = points_[point];
    if (last_point_ >= 0 && std::isfinite(state.remaining)) {
        const double distance = along_[point] - along_[last_point_];
        const double cut = cut_depth(point, distance > 0 ? +1 : -1, remaining);
        // A wheel that climbs removes less than the depth of cut, one that sinks removes more, all along its contact.
        const double climbed = remaining - points_[last_point_].remaining;
        state.removed = std::max(cut * std::abs(distance) - climbed * std::sqrt(2 * radius_ * cut), 0.0);
        state.impulse = impulse;
    }
    state.remaining = remaining;
    last_point_ = point;
}

double ForceControl::next_force_offset(int point, int direction)
{
    const double distance = last_point_ < 0 ? 0 : std::abs(along_[point] - along_[last_point_]);
    force_offset_ = std::min(desired_offset(point, direction), force_offset_ + max_offset_slope_ * distance);
    return force_offset_;
}

double ForceControl::desired_offset(int point, int direction) const
{
    const double learned = learned_q(point);
    if (!(learned > 0)) return 0;
    const double q = std::max(points_[point].impulse > 0 ? kMaxQRatio * learned : learned, min_q_);
    const double force = std::min(cut_depth(point, direction, target_) * feed_ / q, max_force_);
    return std::max((force - preload_) / stiffness_ - target_, 0.0);
}

/// Estimates q around a point from the last stroke; 0: not known.
double ForceControl::learned_q(int point) const
{
    const double here = along_[point];
    if (!std::isfinite(points_[point].remaining)) return 0;
    if (!(points_[point].impulse > 0)) return expected_q(here);
    double removed = 0, impulse = 0;
    for (std::size_t n = 0; n < along_.size(); ++n) {
        if (std::abs(along_[n] - here) > contact_length_) continue;
        removed += points_[n].removed;
        impulse += points_[n].impulse;
    }
    return removed / impulse;
}

/// q where the strokes of this pass have no estimate: the larger of that of the learnt law and the largest estimate of
/// the last pass within a contact length; 0: not known.
double ForceControl::expected_q(double along) const
{
    double q = max_known_q_;
    for (const PassQ& there : last_pass_)
        if (std::abs(there.along - along) <= contact_length_) q = std::max(q, kMaxQRatio * there.q);
    return q;
}

/// Depth of cut of a wheel whose lowest line is at `tip`.
double ForceControl::cut_depth(int point, int direction, double tip) const
{
    const double here = along_[point];
    const int count = int(along_.size());
    double depth = 0;
    for (int n = point; n >= 0 && n < count; n += direction) {
        const double height = stock_height(n) - tip;
        if (!(height > depth)) break;
        const int next = n + direction;
        const bool last = next < 0 || next >= count;
        depth = last ? height : std::min(height, rim(along_[next] - here));
    }
    return depth;
}

/// Upper bound of the stock's height above the reference: it is below the rim of the wheel at every point.
double ForceControl::stock_height(int point) const
{
    const double here = along_[point];
    double z = points_[point].remaining;
    for (const int direction : {-1, +1})
        for (int n = point + direction; n >= 0 && n < int(along_.size()); n += direction) {
            const double rise = rim(along_[n] - here);
            if (rise >= z) break;
            z = std::min(z, points_[n].remaining + rise);
        }
    return z;
}

} // namespace fettle::strategy
