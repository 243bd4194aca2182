#include "belt/running_error.h"

#include <algorithm>
#include <cmath>

namespace fettle::belt {

namespace {

double assessed_count(const AssessmentCounts& counts)
{
    return static_cast<double>(counts.gouge + counts.within + counts.undercut);
}

} // namespace

double RunningError::mean() const { return sum / assessed_count(counts); }

double RunningError::rms() const { return std::sqrt(std::max(sum_squares, 0.0) / assessed_count(counts)); }

RunningError running_error(const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    RunningError error{range, count_assessments(displacement, range)};
    for (const double d : displacement) {
        if (std::isnan(d)) continue;
        error.sum += d;
        error.sum_squares += d * d;
        error.min = std::min(error.min, d);
    }
    return error;
}

void RunningError::update(double before, double after)
{
    if (std::isnan(before)) return;
    --counts[assess(before, range)];
    ++counts[assess(after, range)];
    sum += after - before;
    sum_squares += after * after - before * before;
    min = std::min(min, after);
}

} // namespace fettle::belt
