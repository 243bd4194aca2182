#pragma once

#include <string>

namespace fettle {

/// A number for a machine's program: no exponent, no zeros at its end, no "-0", whatever the locale.
/// @param digits  after the point
std::string to_fixed_text(double value, int digits);

} // namespace fettle
