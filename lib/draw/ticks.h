#pragma once

#include <string>

namespace fettle::draw {

/// Spacing for about `count` ticks over a span: 1, 2 or 5 times a power of ten.
double tick_step(double span, int count);

/// Label of a tick, with as many decimals as the step needs, or with an exponent if these are many; a zero has no sign.
std::string tick_text(double value, double step);

} // namespace fettle::draw
