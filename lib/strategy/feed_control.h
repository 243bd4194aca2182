#pragma once

#include "job/job.h"

namespace fettle {

/// Feed-rate control in layer 1 (Wang 2007, 6.1.4.2): more material left, slower; less, faster. The machine's own loops
/// hold the feed, this one is around them: once in a period it reads the spring's deflection δ, which is what stands
/// over the reference surface, and sets the feed.
///
/// The wheel climbs by s v, s the slope it meets, and sinks by what it grinds off its contact area A:
/// dδ/dt = s v − c F / A, F = preload + k δ. The last period at the feed v tells s v; the feed that holds the target is
///
///   v' = v F_target / (F + A Δδ / (c T)).
///
/// In logarithms this is an integral controller with the removal law as feed-forward: at rest it depends on neither c
/// nor A. If the metal yields m times as fast as c / A says, a share of 1 − m of an error of the feed is left in the
/// next period: stable for m below 2. A is taken as small as it gets, for the least contact length, so that m is
/// below 1.
///
/// Slow is not thorough: the force falls with what is left, so two strokes at the job's feed take off more than one at
/// half of it. Where the target needs less than half of the job's feed, the job's is kept: another stroke is due
/// anyway.
class FeedControl {
  public:
    /// @param remaining  the most that may be left, mm
    FeedControl(const Job& job, double remaining);

    double feed() const { return feed_; }     ///< mm/s
    double period() const { return period_; } ///< s

    /// @param before, after  δ at the beginning and at the end of the last `duration`, mm, s
    void update(double before, double after, double duration);

  private:
    double force(double deflection) const { return deflection > 0 ? preload_ + stiffness_ * deflection : 0; }

    double preload_, stiffness_;
    double target_; ///< N
    double yield_;  ///< c / A, mm/(N s)
    double most_;   ///< feed, mm/s
    double period_;
    double feed_;
};

} // namespace fettle
