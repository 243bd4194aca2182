#pragma once

#include "fit/fit.h"

namespace fettle::fit {

/// The method "auto", Bayesian model averaging (Hoeting et al. 1999) of the families (family_solution.h) and, if no
/// common one of them fits the touches, a Gaussian process (process.h). A family's posterior probability is taken as
/// exp(-score/2), with scores by Schwarz's criterion (family.h; Kass and Raftery 1995, 4.3); rare families (cone,
/// torus, cubic, swept) have smaller prior probabilities and wider priors of their parameters. The surface is the mean
/// of all and named after the most probable one. Plane jobs use only the plane; swept jobs use planes, circular and
/// cubic sections, all straight along the job's direction.
/// @throws InputError if the touches determine no surface
Fit fit_auto(const FitInput& input);

} // namespace fettle::fit
