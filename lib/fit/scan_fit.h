#pragma once

#include "fit/dense.h"
#include "fit/fit.h"

#include <string>

namespace fettle::fit {

/// A surface of any method but "bspline" through the representatives of a scan or of very many touches. "auto" weighs
/// the same families as for touches, each with waves (wavy_family.h); a method of its own name is that family, its
/// covariance allowing for the waves. `touches` of the surface are the representatives.
/// @throws InputError as fit_dense(), and if the representatives do not determine the surface
DenseFit fit_scan(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                  const std::string& method, const std::string& name);

} // namespace fettle::fit
