#pragma once

#include "plan/plan.h"
#include "strategy/run.h"

namespace fettle::station {

/// Time left of the covering of layer 1 under way: the part is unknown, so the rest of it is taken to need as long as
/// what is done did, and at least as long as it takes at the job's feed.
class Forecast {
  public:
    explicit Forecast(const plan::Plan& plan);

    /// Follows the rows of a run, also those of its beginning that are replayed.
    void follow(const strategy::TraceRow& row);
    double time_left() const; ///< s

  private:
    int passes_;
    double covering_time_;  ///< at the job's feed, s
    double begin_ = 0;      ///< of this covering, trace time, s
    double now_ = 0;        ///< trace time, s
    int farthest_pass_ = 1; ///< of this covering
};

} // namespace fettle::station
