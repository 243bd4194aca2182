#pragma once

#include "core/progress.h"

#include <string>

namespace fettle {

/// A progress bar on stderr, from the second second of the work on: short work shows nothing.
Progress progress_bar(const std::string& label);

} // namespace fettle
