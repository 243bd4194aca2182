#pragma once

#include "fit/family_solution.h"

namespace fettle {

/// Three quarters of the touches that lie near one quadratic (plane, if there are few): the least trimmed squares of
/// many small subsets (Rousseeuw and Van Driessen 2006). Slips that outweigh the others in a least-squares fit are not
/// among them.
Columns trimmed_touches(const Touched& touched);

} // namespace fettle
