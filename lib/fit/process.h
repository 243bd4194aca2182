#pragma once

#include "fit/family.h"

namespace fettle {

/// A smooth residual on a free quadratic (a plane, where the touches determine none): z = f + g + e with nothing known
/// of f, and g a Gaussian process with the covariance τ² exp(-|Δ|²/2ℓ²) or Matérn's of 5/2 (universal kriging: Cressie
/// 1993, 3.4; Rasmussen and Williams 2006, 2.7 and 4.2). Which of both, τ and ℓ are integrated over a grid by their
/// restricted likelihood (Patterson and Thompson 1971), orders of magnitude of both alike probable beforehand. The
/// result is one height field, mean and covariance of all of these, on a bicubic B-spline grid. A richer trend than a
/// quadratic takes up what the residual would follow better.
/// @param grid  over B and the touches, the finest to be used; its heights are not read. Cells are as long as the
/// correlations allow.
/// @return  nothing for fewer touches than the trend's parameters and two, or touches on a line
std::optional<Candidate> fit_process(const Touched& touched, const Bspline& grid);

} // namespace fettle
