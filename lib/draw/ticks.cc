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
    constexpr int kMaxDecimals = 6; // smaller steps are written with an exponent
    constexpr double kRounding = 1e-9;
    const double shown = std::abs(value) < step / 1e6 ? 0.0 : value;
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kRounding)));
    char buffer[64];
    if (decimals <= kMaxDecimals) {
        std::snprintf(buffer, sizeof buffer, "%.*f", decimals, shown);
        return buffer;
    }
    if (shown == 0) return "0";
    // The digits from the value's first to the step's.
    const int digits = decimals + 1 + static_cast<int>(std::floor(std::log10(std::abs(shown)) + kRounding));
    std::snprintf(buffer, sizeof buffer, "%.*g", std::max(1, digits), shown);
    return buffer;
}

} // namespace fettle::draw
