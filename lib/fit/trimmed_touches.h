#pragma once

#include "fit/family_solution.h"

namespace fettle::fit {

/// The three quarters of the touches that lie nearest to one quadratic (a plane, if there are few touches): least
/// trimmed squares from many random subsets (Rousseeuw and Van Driessen 2006). They do not contain outliers, even if
/// these would dominate a least-squares fit.
TouchIndices trimmed_touches(const TouchSet& touches);

} // namespace fettle::fit
