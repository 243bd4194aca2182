#include "belt/running_error.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

Eigen::Index& count_of(AssessmentCounts& counts, Assessment found)
{
    return found == Assessment::gouge ? counts.gouge : found == Assessment::undercut ? counts.undercut : counts.within;
}

double known(const AssessmentCounts& counts)
{
    return static_cast<double>(counts.gouge + counts.within + counts.undercut);
}

} // namespace

double RunningError::mean() const { return sum / known(counts); }

double RunningError::rms() const { return std::sqrt(std::max(squares, 0.0) / known(counts)); }

RunningError running_error(const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    RunningError error{range, count(displacement, range)};
    for (const double d : displacement) {
        if (std::isnan(d)) continue;
        error.sum += d;
        error.squares += d * d;
        error.least = std::min(error.least, d);
    }
    return error;
}

void change(RunningError& error, double before, double after)
{
    if (std::isnan(before)) return;
    --count_of(error.counts, assess(before, error.range));
    ++count_of(error.counts, assess(after, error.range));
    error.sum += after - before;
    error.squares += after * after - before * before;
    error.least = std::min(error.least, after);
}

} // namespace fettle
