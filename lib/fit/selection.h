#pragma once

#include "fit/fit.h"

namespace fettle {

/// The method "auto": the families (family_solution.h) are weighed against each other, and where none of them explains
/// the touches, against the B-spline, whose smooth residual may be anything. A family's probability given the touches
/// is taken as exp(-score/2), scores by Schwarz's criterion (family.h; Kass and Raftery 1995, 4.3), before the touches
/// all are as probable as each other. The surface is their mean (Hoeting et al. 1999, Bayesian model averaging); the
/// most probable one gives it its name. Plane jobs take the plane; swept jobs weigh planes, circular and cubic
/// sections, all straight along the job's direction.
/// @throws InputError if the touches determine no surface
Fit fit_auto(const FitInput& input);

} // namespace fettle
