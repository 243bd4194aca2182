#pragma once

#include "fit/family_solution.h"

namespace fettle::fit {

/// The quadric with the least squares of the vertical errors of some touches, by Levenberg and Marquardt (Ceres).
/// @param paraboloid  quadratic polynomial fitted to the touches, to start from
/// @return  nothing if they do not determine a quadric whose gradient varies little over all touches
std::optional<FamilySolution> solve_quadric(const TouchSet& touched, const TouchIndices& kept,
                                            const surface::Polynomial& paraboloid);

/// An ellipsoid, a hyperboloid or a paraboloid with the sphere among them, as many parameters as a paraboloid: of the
/// quadric's form the mixed terms with the normal amid the touches are 0, and that along it is the mean of the two
/// across. Paraboloids lie about a sphere with errors of the fourth order, which touches around an anomaly do not show.
/// @return  likewise; nothing for touches that determine none
std::optional<FamilySolution> solve_ellipsoid(const TouchSet& touched, const TouchIndices& kept,
                                              const surface::Polynomial& paraboloid);

} // namespace fettle::fit
