#pragma once

#include "fit/family.h"
#include "fit/fit.h"

#include <string>
#include <vector>

namespace fettle::fit {

/// The method "auto", Bayesian model averaging (Hoeting et al. 1999) of the families (family_solution.h) and, if no
/// common one of them fits the touches, a Gaussian process (process.h). A family's posterior probability is taken as
/// exp(-score/2), with scores by Schwarz's criterion (family.h; Kass and Raftery 1995, 4.3), times prior_penalty()'s
/// priors; rare families (is_rare()) have wider priors of their parameters, too. The surface is the mean
/// of all and named after the most probable one. Plane jobs use only the plane; swept jobs use planes, circular and
/// cubic sections, all straight along the job's direction.
/// @throws InputError if the touches determine no surface
Fit fit_auto(const FitInput& input);

// --- shared with the fit of scans (scan_fit.h)
// ------------------------------------------------------------------------

/// Cones, tori and surfaces (sections) of varying curvature: their prior of the further parameters is wider, they are
/// believed only with touches enough for each parameter, and a process is weighed beside them.
bool is_rare(const std::string& family);

/// −2 ln of a family's relative prior probability. Castings are mostly planes, cylinders, spheres and what bends a
/// little differently both ways, ellipsoids; paraboloids, which differ from those by terms of the fourth order that
/// only a formula makes zero, the rare families and a process ("gp") count as four times rarer. A cubic, the next terms
/// of a series, is no more a casting's form than those, but has ten parameters, and touches of a sphere are overfitted
/// by it most easily: ten times. With equal priors, sixteen touches of a common family are overfitted by a rare one in
/// one case of twenty.
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
