#include "strategy/wheel_wear.h"

#include <numbers>

namespace fettle {
namespace {

/// Volume of stock per volume of wheel: common wheels reach 20 to 80 on steel and iron.
constexpr double kSoftest = 20;
/// The rate that was learned holds within three tenths; of what may remain a quarter is for that (feed_control.cc).
constexpr double kMostPerRemaining = 0.25 / 0.3;
/// Before anything is learned nothing is gone down by.
constexpr double kUnlearned = 0.5;
constexpr double kCautious = 0.7;

} // namespace

WheelWear::WheelWear(const Job& job, double remaining)
    : steepest_(job.removal / (kSoftest * 2 * std::numbers::pi * job.wheel.min_radius * job.wheel.width)),
      most_(kMostPerRemaining * remaining)
{
}

void WheelWear::measured(double radius)
{
    if (radius_ > 0) {
        worn_ += radius_ - radius;
        work_ += impulse_;
    }
    radius_ = radius;
    impulse_ = 0;
}

void WheelWear::renewed()
{
    radius_ = 0;
    impulse_ = 0;
}

double WheelWear::loss() const { return worn_ > 0 ? kCautious * worn_ / work_ * impulse_ : 0; }

bool WheelWear::due() const
{
    const bool learned = worn_ > 0;
    return impulse_ * (learned ? worn_ / work_ : steepest_) > most_ * (learned ? 1 : kUnlearned);
}

} // namespace fettle
