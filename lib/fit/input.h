#pragma once

#include "cloud/cloud.h"
#include "fit/fit.h"

namespace fettle {

/// What a cloud says of its touches: their roles (points without the field are samples) and the numbers of their lines.
/// @param source  its name in messages
/// @throws InputError for a role that there is not
FitInput fit_input(const Job& job, const Cloud& cloud, const std::string& source);

} // namespace fettle
