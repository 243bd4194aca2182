#pragma once

#include "fit/family.h"

namespace fettle {

/// A smooth residual on the best trends: z = f + g + e with f of a family, near its best member linear in θ of which
/// nothing is known, and g a Gaussian process with the covariance τ² exp(-|Δ|²/2ℓ²) (universal kriging: Cressie 1993,
/// 3.4; Rasmussen and Williams 2006, 2.7). τ and ℓ are integrated over a grid by their restricted likelihood
/// (Patterson and Thompson 1971), orders of magnitude of τ alike probable beforehand, and so are the trends. The result
/// is one height field, mean and covariance of all of these, on a bicubic B-spline grid.
/// @param trends  families fitted to the touches   @param grid  over B and the touches; its heights are not read
/// @return  nothing without a trend that is defined all over the grid
std::optional<Candidate> fit_process(const Touched& touched, const std::vector<Candidate>& trends, const Bspline& grid);

} // namespace fettle
