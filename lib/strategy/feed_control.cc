#include "strategy/feed_control.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// Of what may remain. The rest is for the transducer's noise and the drives' errors.
constexpr double kTarget = 0.75;
constexpr double kPeriod = 0.02; // s, 0.5 mm at 1 in/s: as often as a plan lets the force be read
constexpr double kTwoStrokes = 0.5;

} // namespace

FeedControl::FeedControl(const Job& job, double remaining)
    : preload_(job.force.preload), stiffness_(job.force.stiffness), target_(force(kTarget * remaining)),
      yield_(job.removal / (std::sqrt(2 * job.wheel.radius * kTarget * remaining) * job.wheel.width)),
      most_(job.feed.rate), period_(kPeriod), feed_(job.feed.rate)
{
}

void FeedControl::update(double before, double after, double duration)
{
    const double taken = force(after) + (after - before) / (yield_ * duration);
    const double wanted = taken > 0 ? feed_ * target_ / taken : most_;
    feed_ = wanted < kTwoStrokes * most_ ? most_ : std::min(wanted, most_);
}

} // namespace fettle
