#include "draw/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fettle::draw {

double tick_step(double span, int count)
{
    const double raw = span / count;
    const double power = std::pow(10, std::floor(std::log10(raw)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= raw) return digit * power;
    return 10 * power;
}

std::string tick_text(double value, double step)
{
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.*f", std::min(decimals, 9), std::abs(value) < step / 1e6 ? 0.0 : value);
    return buffer;
}

} // namespace fettle::draw
