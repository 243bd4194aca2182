#include "strategy/feed_control.h"

#include <algorithm>
#include <cmath>

namespace fettle::strategy {
namespace {

/// Target height relative to the height that may remain; the rest is for the transducer's noise and the drives' errors.
constexpr double kFeedTargetShare = 0.75;
constexpr double kFeedPeriod = 0.02;  // s; 0.5 mm at 1 in/s: as often as a plan lets the force be read
constexpr double kMinFeedShare = 0.5; // of the job's feed; two strokes remove more than one slower stroke
constexpr int kMaxStrokes = 20;       // over one place; more only at the job's feed

} // namespace

FeedControl::FeedControl(const job::Job& job, double max_remaining)
    : preload_(job.force.preload), stiffness_(job.force.stiffness), target_(force(kFeedTargetShare * max_remaining)),
      removal_rate_(job.removal_coefficient /
                    (std::sqrt(2 * job.wheel.radius * kFeedTargetShare * max_remaining) * job.wheel.width)),
      stroke_rate_(job.force.stiffness * job.removal_coefficient / (job.wheel.width * job.feed.rate)),
      max_feed_(job.feed.rate), period_(kFeedPeriod), feed_(job.feed.rate)
{
}

void FeedControl::update(double before, double after, double duration)
{
    const double ground_force = force(after) + (after - before) / (removal_rate_ * duration);
    const double feed = ground_force > 0 ? feed_ * target_ / ground_force : max_feed_;
    feed_ = feed < kMinFeedShare * max_feed_ ? feed_of_strokes(max_feed_ / feed) : std::min(feed, max_feed_);
}

/// The feed with which the fewest strokes leave the target. @param excess  of the force that the job's feed leaves,
/// over the target
double FeedControl::feed_of_strokes(double excess) const
{
    const double stock = excess * (1 + stroke_rate_); // force of the stock's height over the target
    for (int n = 2; n <= kMaxStrokes; ++n) {
        const double rate = std::pow(stock, 1.0 / n) - 1;
        if (kMinFeedShare * rate <= stroke_rate_) return std::min(max_feed_, max_feed_ * stroke_rate_ / rate);
    }
    return max_feed_;
}

} // namespace fettle::strategy
