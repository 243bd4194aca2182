#pragma once

#include "core/progress.h"

#include <string>

namespace fettle::cli {

/// Progress bar on stderr. It appears after one second, so that short computations show nothing.
core::Progress progress_bar(const std::string& label);

} // namespace fettle::cli
