#pragma once

#include "belt/assess.h"

#include <Eigen/Core>

#include <limits>

namespace fettle::belt {

/// Error statistics of the surfels while a part is being ground ("online assessment", Ren et al. 2006). An update costs
/// the same however many surfels there are.
struct RunningError {
    ToleranceRange range;
    AssessmentCounts counts;
    double sum = 0, sum_squares = 0;                      ///< mm, mm²
    double min = std::numeric_limits<double>::infinity(); ///< mm, so far: grinding only lowers displacements

    double mean() const; ///< mm
    double rms() const;  ///< mm
    /// @param before  displacement of a surfel, mm; NaN changes nothing
    /// @param after   of the same surfel, mm
    void update(double before, double after);
};

/// @param displacement  of all surfels, mm; NaN: none
RunningError running_error(const Eigen::VectorXd& displacement, const ToleranceRange& range);

} // namespace fettle::belt
