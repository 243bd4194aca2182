#pragma once

#include <string>

namespace fettle {

/// Spacing of about `count` ticks over a span: 1, 2 or 5 times a power of ten.
double tick_step(double span, int count);

/// As many decimals as the step needs. A rounded zero has no sign.
std::string tick_text(double value, double step);

} // namespace fettle
