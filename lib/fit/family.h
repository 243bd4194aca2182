#pragma once

#include "fit/family_solution.h"
#include "fit/fit.h"

#include <optional>

namespace fettle {

// A family is a set of surfaces with few parameters (family_solution.h). Touches that are better explained as slips
// (one in twenty, anywhere within an inch) than as touches of the surface are left out one by one, and come back when
// they fit after all. A family's score is Schwarz's criterion (1978) with the probe's noise known:
//     Σ (r/σ)² + parameters · ln(touches) + slips · (price of a slip).

/// One family, fitted.
struct Candidate {
    std::string method;
    Shape shape;
    Eigen::MatrixXd covariance;
    Columns gross_errors;
    double score = 0;
    double chi2 = 0;    ///< Σ (r/σ)² of the touches that were not left out
    double freedom = 0; ///< of that sum
    bool converged = true;
    int iterations = 0;
};

/// @param kept  touches to begin with
/// @return  nothing if they do not determine such a surface
std::optional<Candidate> fit_family(const std::string& name, const Touched& touched, const Columns& kept);

/// All touches.
Columns all_touches(const Touched& touched);

/// −2 ln of the odds that a touch is a slip, against a touch with no error. With ν degrees of freedom of sigma the
/// residual's density is Student's t, ∝ (1 + χ²/ν)^(-(ν+1)/2), and the price is the χ² at which that is as improbable.
/// @param sigma  of a touch, mm
double price_of_a_slip(double sigma, double freedom = std::numeric_limits<double>::infinity());

/// The probability that χ² is as large by chance.
double goodness(double chi2, double freedom);

/// The method of a family's name.
/// @throws InputError if the touches do not determine such a surface
Fit fit_family_by_name(const FitInput& input, const std::string& name);

/// @throws InputError always: what is wrong with touches that determine no such surface
[[noreturn]] void refuse_undetermined(const Touched& touched, const std::string& name, const std::string& source);

/// What families are fitted to: the touches and the noise of a surface that begin_surface() made.
Touched touched_of(const Surface& surface, const Job& job);

} // namespace fettle
