#pragma once

#include "fit/family_solution.h"
#include "fit/round_family.h"

namespace fettle::fit {

/// Singular values below this fraction of the largest count as zero in a design matrix with columns of unit length;
/// single-precision files round touches by 6e-8 of their size.
inline constexpr double kSolutionRankThreshold = 1e-5;

/// Initial estimate of round surfaces from the quadratic of least squares.
struct RoundStart {
    RoundProblem problem;      ///< the frame's first axis is the direction of min_curvature
    double min_curvature = 0;  ///< principal curvatures by absolute value, > 0 convex, 1/mm; with a given direction
    double max_curvature = 0;  ///< the curvatures along and across it
    bool is_determined = true; ///< the touches determine the quadratic, and so the directions
};

/// @param frame  the zero quadratic, in coordinates centred and scaled to the kept touches
RoundStart round_start(const TouchSet& touches, const TouchIndices& kept, const surface::Polynomial& frame);

/// The frame rotated about its normal. @param angle  rad
RoundFrame rotated(const RoundFrame& frame, double angle);

} // namespace fettle::fit
