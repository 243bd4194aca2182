#pragma once

#include <string>

namespace fettle::core {

/// Formats a number for a machine's program: no exponent, no trailing zeros, no "-0", independent of the locale.
/// @param digits  at most so many after the decimal point
std::string to_fixed_text(double value, int digits);

} // namespace fettle::core
