#pragma once

#include "fit/fit.h"

namespace fettle {

/// The method "auto": the families (family_solution.h) are weighed against each other, and where no common one of them
/// explains the touches, against a Gaussian process (process.h). A family's probability given the touches is taken as
/// exp(-score/2), scores by Schwarz's criterion (family.h; Kass and Raftery 1995, 4.3); rare families (cone, torus,
/// cubic, swept) are less probable before the touches, and pay more for what they explain. The surface is the mean of
/// all (Hoeting et al. 1999, Bayesian model averaging); the most probable one gives it its name. Plane jobs take the
/// plane; swept jobs weigh planes, circular and cubic sections, all straight along the job's direction.
/// @throws InputError if the touches determine no surface
Fit fit_auto(const FitInput& input);

} // namespace fettle
