#pragma once

#include "fit/family_solution.h"

namespace fettle::fit {

/// The quadric with the least squares of the vertical errors of some touches, by Levenberg and Marquardt (Ceres).
/// @param paraboloid  quadratic polynomial fitted to the touches, to start from
/// @return  nothing if they do not determine a quadric whose gradient varies little over all touches
std::optional<FamilySolution> solve_quadric(const TouchSet& touched, const TouchIndices& kept,
                                            const surface::Polynomial& paraboloid);

} // namespace fettle::fit
