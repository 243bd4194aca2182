#pragma once

#include "belt/assess.h"

#include <Eigen/Core>

#include <limits>

namespace fettle {

/// Displacements as errors while a part is being ground ("online assessment", Ren et al. 2006): a change of one costs
/// the same however many there are.
struct RunningError {
    ToleranceRange range;
    AssessmentCounts counts;
    double sum = 0, squares = 0;                            ///< mm, mm²
    double least = std::numeric_limits<double>::infinity(); ///< so far: grinding only takes away

    double mean() const;
    double rms() const;
};

RunningError running_error(const Eigen::VectorXd& displacement, const ToleranceRange& range);

/// @param before  of a surfel, mm; NaN changes nothing
void change(RunningError& error, double before, double after);

} // namespace fettle
