#pragma once

#include "job/job.h"

namespace fettle::strategy {

/// Feed-rate control in layer 1 (Wang 2007, 6.1.4.2): the more material is left, the slower the feed. It is an outer
/// loop around the machine's own feed control: once in a period it reads the spring's deflection δ, which is the height
/// of the stock above the reference surface, and sets the feed.
///
/// The wheel climbs by s v, where s is the slope of the stock, and sinks by what it grinds off its contact area A:
/// dδ/dt = s v − c F / A, F = preload + k δ. The last period at the feed v yields s v; the feed that holds the target
/// is
///
///   v' = v F_target / (F + A Δδ / (c T)).
///
/// In logarithms this is an integral controller with the removal law as feed-forward: in steady state it depends on
/// neither c nor A. If the metal is removed m times as fast as c / A predicts, the share 1 − m of a feed error is left
/// in the next period: stable for m below 2. A is the smallest possible contact area, that of the shortest contact
/// length, so m is below 1.
///
/// A slow feed is not thorough: the force falls with what is left, so two strokes at the job's feed remove more than
/// one at half of it. Where the target needs less than half of the job's feed, more strokes are due, and all go as fast
/// as the fewest of them allow. Over flat stock of the height h a stroke at the feed v leaves δ, h − δ = c F / (w v)
/// with the wheel's width w; so with κ = k c / (w v) n strokes lower the force of the height by (1 + κ)ⁿ, and
///
///   (1 + κ)ⁿ F_target = F(h) = (1 + κ_job) F_job,
///
/// where F_job is what the job's feed would leave, by the last period.
class FeedControl {
  public:
    /// @param max_remaining  largest height that may be left above the reference surface, mm
    FeedControl(const job::Job& job, double max_remaining);

    double feed() const { return feed_; }     ///< mm/s
    double period() const { return period_; } ///< s

    /// @param before, after  δ at the beginning and at the end of the last `duration`, mm, s
    void update(double before, double after, double duration);

  private:
    double feed_of_strokes(double excess) const;
    double force(double deflection) const { return deflection > 0 ? preload_ + stiffness_ * deflection : 0; }

    double preload_, stiffness_;
    double target_;       ///< N
    double removal_rate_; ///< c / A, mm/(N s)
    double stroke_rate_;  ///< κ at the job's feed
    double max_feed_;     ///< mm/s
    double period_;
    double feed_;
};

} // namespace fettle::strategy
