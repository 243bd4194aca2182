#pragma once

#include "fit/fit.h"

namespace fettle {

/// Straight swept surface: cubic section and slope of the rulings in one robust least-squares fit to all touches. Wang
/// (2007, 4.4.2 and 4.4.4) fits the line to its three touches and the section to its four; the joint fit is exact on
/// the same surfaces and uses that the line's touches lie on the section, too. The direction of the rulings in x-y is
/// the job's.
/// @throws InputError for fewer than 5 touches, fewer than four places across the rulings, or no extent along them
Fit fit_swept(const FitInput& input);

} // namespace fettle
