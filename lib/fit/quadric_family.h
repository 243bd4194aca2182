#pragma once

#include "fit/family_solution.h"

namespace fettle {

/// Least squares of the vertical errors of some touches over all quadrics, by Levenberg and Marquardt (Ceres), from the
/// paraboloid that goes through them.
/// @param paraboloid  quadratic polynomial fitted to the touches
/// @return  nothing if they do not determine a quadric that stays near its shape over all touches
std::optional<FamilySolution> solve_quadric(const Touched& touched, const Columns& kept, const Polynomial& paraboloid);

} // namespace fettle
