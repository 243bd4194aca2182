#pragma once

#include "geometry/statistics.h"

namespace fettle::compare {

/// Conformity of a part: at least one point has an error, and no |error| exceeds the tolerance widened by the rounding
/// of float coordinates in files.
struct Conformity {
    bool within = false;
    double max_abs_error = 0; ///< largest |error|, mm; NaN if no point has one
};
/// @param max_coordinate  largest |coordinate| of the points, mm
Conformity judge_conformity(const geometry::Statistics& statistics, double tolerance, double max_coordinate);

} // namespace fettle::compare
