#pragma once

#include "core/constants.h"

#include <cmath>

namespace fettle::surface {

/// The root of a t² + b t + c with a positive derivative; NaN without real roots. Free of cancellation; a may be 0.
inline double increasing_root(double a, double b, double c)
{
    const double discriminant = b * b - 4 * a * c;
    if (!(discriminant > 0)) return core::kNaN;
    const double root = std::sqrt(discriminant);
    return b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a);
}

} // namespace fettle::surface
