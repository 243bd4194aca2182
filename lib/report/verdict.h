#pragma once

#include "report/run_files.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace fettle::report {

/// The errors of a ground part, apart by what made them. At a point where the wheel removed r and that ends d below the
/// reference, the wheel over-cut by min(d, r); by d - r the part lacked metal before it was ground. On slopes, where r
/// is along z, the wheel is blamed for the difference. Units of the run.
struct OverCut {
    double by_wheel = 0; ///< deepest, not negative
    double lacked = 0;   ///< most that was missing before grinding, not negative
    double left = 0;     ///< most material left, not negative
    Eigen::Index lacking_points = 0;
    Eigen::Index points = 0; ///< judged: those with an error
};
/// @param errors, removed  of the judged points; NaN errors are left out; where `removed` is not known, the wheel
/// counts as the cause
/// @param rounding  of the errors: what lacks no more than that lacks nothing
OverCut split_over_cut(const Eigen::VectorXd& errors, const Eigen::VectorXd& removed, double rounding);

/// What a page says about the part.
struct PageVerdict {
    bool is_judged = false; ///< false: no comparison, or one without a tolerance
    bool within = false;
    double worst = 0, tolerance = 0; ///< units of the run; worst: NaN if no point has an error
    bool by_wheel = false;           ///< what the part lacked before it was ground is not counted
    std::optional<OverCut> over_cut; ///< of the judged region, where the error map knows what was removed
};
PageVerdict judge_page(const RunFiles& run);

} // namespace fettle::report
