#include "strategy/wheel_wear.h"

#include <numbers>

namespace fettle::strategy {
namespace {

/// Volume of stock per volume of wheel: common wheels have 20 to 80 on steel and iron.
constexpr double kMinGrindingRatio = 20;
/// The learned wear rate is accurate to 30 %, and a quarter of the height that may remain is reserved for its error
/// (feed_control.cc).
constexpr double kMaxLossPerRemaining = 0.25 / 0.3;
/// Before a rate is learned, the whole loss is an error, not 30 % of it: a smaller loss is allowed.
constexpr double kUnlearnedShare = 0.5;
/// Share of the estimated loss that is compensated, so that nothing is ground too deep.
constexpr double kLossShare = 0.7;

} // namespace

WheelWear::WheelWear(const job::Job& job, double max_remaining)
    : max_rate_(job.removal_coefficient /
                (kMinGrindingRatio * 2 * std::numbers::pi * job.wheel.min_radius * job.wheel.width)),
      max_loss_(kMaxLossPerRemaining * max_remaining)
{
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

double WheelWear::loss() const { return kLossShare * expected_loss(); }

double WheelWear::expected_loss() const { return total_loss_ > 0 ? total_loss_ / total_impulse_ * impulse_ : 0; }

bool WheelWear::measurement_due() const
{
    const bool learned = total_loss_ > 0;
    return impulse_ * (learned ? total_loss_ / total_impulse_ : max_rate_) >
           max_loss_ * (learned ? 1 : kUnlearnedShare);
}

} // namespace fettle::strategy
