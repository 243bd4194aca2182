#pragma once

#include <cmath>
#include <limits>

namespace fettle {

/// The root of a t² + b t + c at which the parabola rises; NaN if there is none. No cancellation, a may be 0.
inline double rising_root(double a, double b, double c)
{
    const double discriminant = b * b - 4 * a * c;
    if (!(discriminant > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double root = std::sqrt(discriminant);
    return b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a);
}

} // namespace fettle
