#pragma once

#include <functional>

namespace fettle {

/// Called by long work with the fraction done, 0 to 1, from one thread. Empty: nobody looks.
using Progress = std::function<void(double fraction)>;

inline void tell(const Progress& progress, double fraction)
{
    if (progress) progress(fraction);
}

} // namespace fettle
