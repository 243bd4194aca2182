#pragma once

#include "fit/family.h"
#include "fit/fit.h"

#include <string>
#include <vector>

namespace fettle::fit {

/// The method "auto", Bayesian model averaging (Hoeting et al. 1999) of the families (family_solution.h) and, if no
/// common one of them fits the touches, a Gaussian process (process.h). A family's posterior probability is taken as
/// exp(-score/2), with scores by Schwarz's criterion (family.h; Kass and Raftery 1995, 4.3); rare families (cone,
/// torus, cubic, swept) have smaller prior probabilities and wider priors of their parameters. The surface is the mean
/// of all and named after the most probable one. Plane jobs use only the plane; swept jobs use planes, circular and
/// cubic sections, all straight along the job's direction.
/// @throws InputError if the touches determine no surface
Fit fit_auto(const FitInput& input);

// --- shared with the fit of scans (scan_fit.h)
// ------------------------------------------------------------------------

/// −2 ln of a family's relative prior probability. Castings are mostly planes, cylinders, spheres and nearly quadratic;
/// cones, tori and surfaces (sections) of varying curvature count as four times rarer. With equal priors, sixteen
/// touches of a common family are overfitted by a rare one in one case of twenty.
double prior_penalty(const std::string& family);

/// The families that are weighed for a free-form or swept job.
std::vector<std::string> candidate_families(job::SurfaceType type);

struct WeightedCandidate {
    FitCandidate candidate;
    double weight = 0; ///< relative
};

/// Makes the candidates the surface and its alternatives, by descending weight.
void set_candidates(std::vector<WeightedCandidate> candidates, surface::Surface& surface);

} // namespace fettle::fit
