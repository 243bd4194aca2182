#pragma once

#include <functional>

namespace fettle::core {

/// Callback for long computations, called from one thread with the fraction done, 0 to 1. It may be empty.
using Progress = std::function<void(double fraction)>;

inline void report_progress(const Progress& progress, double fraction)
{
    if (progress) progress(fraction);
}

} // namespace fettle::core
