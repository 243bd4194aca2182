#include "strategy/wheel_wear.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::strategy {
namespace {

/// Volume of stock per volume of wheel: common wheels have 20 to 80 on steel and iron.
constexpr double kMinGrindingRatio = 20;
/// A quarter of the height that may remain is reserved for the error of the wear (feed_control.cc).
constexpr double kErrorPerRemaining = 0.25;
/// A wear rate that was learned in this run alone is accurate to 30 %.
constexpr double kLearnedSigma = 0.3;
/// Before a rate is learned, the whole loss is an error, not 30 % of it: a smaller loss is allowed.
constexpr double kUnlearnedShare = 0.5;

} // namespace

WheelWear::WheelWear(const job::Job& job, double max_remaining, const std::optional<KnownRemoval>& known)
    : is_known_(known && known->lost_volume > 0),
      sigma_(is_known_ ? std::min(std::hypot(known->wear_sigma, known->coefficient_sigma), kLearnedSigma)
                       : kLearnedSigma),
      max_rate_(job.removal_coefficient /
                (kMinGrindingRatio * 2 * std::numbers::pi * job.wheel.min_radius * job.wheel.width)),
      max_loss_(kErrorPerRemaining / sigma_ * max_remaining)
{
    if (!is_known_) return;
    total_loss_ = known->lost_volume / (2 * std::numbers::pi * job.wheel.radius * job.wheel.width);
    total_impulse_ = known->removed_volume / job.removal_coefficient;
}

void WheelWear::set_measured_radius(double radius)
{
    if (radius_ > 0) {
        total_loss_ += radius_ - radius;
        total_impulse_ += impulse_;
    }
    radius_ = radius;
    impulse_ = 0;
}

void WheelWear::start_new_wheel()
{
    radius_ = 0;
    impulse_ = 0;
}

double WheelWear::loss() const { return (1 - sigma_) * expected_loss(); }

double WheelWear::expected_loss() const { return total_loss_ > 0 ? total_loss_ / total_impulse_ * impulse_ : 0; }

bool WheelWear::measurement_due() const
{
    const bool learned = total_loss_ > 0;
    return impulse_ * (learned ? total_loss_ / total_impulse_ : max_rate_) >
           max_loss_ * (learned ? 1 : kUnlearnedShare);
}

} // namespace fettle::strategy
