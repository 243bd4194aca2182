#include "station/forecast.h"

#include <algorithm>

namespace fettle::station {
namespace {

double covering_length(const plan::Plan& plan)
{
    double length = 0;
    for (const plan::Pass& pass : plan.passes)
        for (const job::Interval& interval : pass.intervals) length += interval.second - interval.first;
    return length;
}

} // namespace

Forecast::Forecast(const plan::Plan& plan)
    : passes_(int(plan.passes.size())), covering_time_(covering_length(plan) / plan.job.feed.rate)
{
}

void Forecast::follow(const strategy::TraceRow& row)
{
    now_ = row.time;
    if (row.event == strategy::Event::start || row.event == strategy::Event::covering_done ||
        row.event == strategy::Event::roughed) {
        begin_ = row.time;
        farthest_pass_ = 1;
    }
    if (row.layer == 1) farthest_pass_ = std::max(farthest_pass_, row.pass);
}

double Forecast::time_left() const
{
    const double done = double(farthest_pass_ - 1) / std::max(passes_, 1); // whole passes
    const double at_this_pace = done > 0 ? (now_ - begin_) / done : 0;
    return (1 - done) * std::max(covering_time_, at_this_pace);
}

} // namespace fettle::station
