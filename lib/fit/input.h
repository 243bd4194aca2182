#pragma once

#include "cloud/cloud.h"
#include "fit/fit.h"

namespace fettle::fit {

/// Fit input from a cloud of touches with optional fields `role` (without it, all points are samples) and `curve`, the
/// numbers of their lines.
/// @param source  the cloud's name in messages
/// @throws InputError for an unknown role
FitInput fit_input(const job::Job& job, const cloud::Cloud& cloud, const std::string& source);

} // namespace fettle::fit
