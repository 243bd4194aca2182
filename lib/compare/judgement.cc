#include "compare/judgement.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::compare {

Conformity judge_conformity(const geometry::Statistics& statistics, double tolerance, double max_coordinate)
{
    if (statistics.count == 0) return {false, core::kNaN};
    // Each of the two files contributes half a unit in the last place.
    const double rounding = static_cast<double>(std::numeric_limits<float>::epsilon()) * max_coordinate;
    const double max_abs_error = std::max(std::abs(statistics.min), std::abs(statistics.max));
    return {max_abs_error <= tolerance + rounding, max_abs_error};
}

} // namespace fettle::compare
