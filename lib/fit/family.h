#pragma once

#include "fit/family_solution.h"
#include "fit/fit.h"

#include <optional>

namespace fettle::fit {

// A family is a set of surfaces with few parameters (family_solution.h). Touches that are better explained as outliers
// (one in twenty, uniformly distributed over an inch) are left out one by one, and taken back if they fit after all. A
// family's score is Schwarz's criterion (1978) for known noise:
//     Σ (r/σ)² + parameters · ln(touches) + outliers · outlier_penalty.

/// A fitted family.
struct FitCandidate {
    std::string method;
    surface::Shape shape;
    Eigen::MatrixXd covariance;
    TouchIndices outliers;
    double score = 0;
    double chi2 = 0;    ///< Σ (r/σ)² of the touches that are no outliers
    double freedom = 0; ///< degrees of freedom of chi2
    bool converged = true;
    int iterations = 0;
};

/// @param kept  touches to start with; the others start as outliers
/// @return  nothing if they do not determine such a surface
std::optional<FitCandidate> fit_family(const std::string& name, const TouchSet& touches, const TouchIndices& kept);

/// The indices of all touches.
TouchIndices all_touches(const TouchSet& touches);

/// −2 ln of the odds of an outlier against a touch without error. If sigma has ν degrees of freedom, the residual's
/// density is Student's t, ∝ (1 + χ²/ν)^(-(ν+1)/2), and the penalty is the χ² at which it is as improbable as an
/// outlier.
/// @param sigma  of a touch, mm
double outlier_penalty(double sigma, double freedom = std::numeric_limits<double>::infinity());

/// Fits one family, for its name as the method.
/// @throws InputError if the touches do not determine such a surface
Fit fit_family_by_name(const FitInput& input, const std::string& name);

/// @throws InputError always, for touches that do not determine a surface
[[noreturn]] void refuse_undetermined(const TouchSet& touches, const std::string& name, const std::string& source);

/// The touches and their noise of a surface that begin_surface() made.
TouchSet make_touch_set(const surface::Surface& surface, const job::Job& job);

} // namespace fettle::fit
