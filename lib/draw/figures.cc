#include "draw/figures.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fettle::draw {
namespace {

constexpr const char* kMinus = "\u2212";
constexpr const char* kThinSpace = "\u202F"; // narrow, does not break

std::string with_sign(bool negative, const std::string& digits)
{
    const bool zero = digits.find_first_of("123456789") == std::string::npos;
    return (negative && !zero ? kMinus : "") + digits;
}

} // namespace

int decimals_for(double largest)
{
    constexpr int kSignificantDigits = 3, kMaxDecimals = 6;
    if (!(largest > 0) || !std::isfinite(largest)) return kSignificantDigits - 1;
    return std::clamp(kSignificantDigits - 1 - static_cast<int>(std::floor(std::log10(largest))), 0, kMaxDecimals);
}

std::string fixed_text(double value, int decimals)
{
    if (!std::isfinite(value)) return "\u2013";
    char buffer[400]; // enough for the largest double
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, std::abs(value));
    return with_sign(value < 0, buffer);
}

std::string short_text(double value)
{
    if (!std::isfinite(value)) return "\u2013";
    constexpr double kMinFixed = 1e-4, kMaxFixed = 1e6;
    const double size = std::abs(value);
    if (size == 0) return "0";
    char buffer[64];
    if (size < kMinFixed || size >= kMaxFixed) {
        std::snprintf(buffer, sizeof buffer, "%.2e", size);
        return with_sign(value < 0, buffer);
    }
    constexpr double kMinGrouped = 1e4;
    if (size >= kMinGrouped) return with_sign(value < 0, count_text(size));
    std::string digits = fixed_text(size, decimals_for(size));
    if (digits.find('.') != std::string::npos) { // 2.50 is 2.5, 3.00 is 3
        digits.erase(digits.find_last_not_of('0') + 1);
        if (digits.back() == '.') digits.pop_back();
    }
    return with_sign(value < 0, digits);
}

std::string duration_text(double seconds)
{
    if (!std::isfinite(seconds)) return "\u2013";
    constexpr double kMinute = 60, kHour = 3600;
    if (seconds < kMinute) return short_text(seconds) + " s";
    char buffer[64];
    const long whole = std::lround(seconds);
    if (seconds < kHour)
        std::snprintf(buffer, sizeof buffer, "%ld min %02ld s", whole / 60, whole % 60);
    else
        std::snprintf(buffer, sizeof buffer, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
    return buffer;
}

std::string count_text(double count)
{
    std::string digits = fixed_text(count, 0);
    for (std::ptrdiff_t place = std::ptrdiff_t(digits.size()) - 3; place > 0; place -= 3)
        digits.insert(static_cast<std::size_t>(place), kThinSpace);
    return digits;
}

Html number_element(const std::string& key, double value, const std::string& text)
{
    return element("span", {{"class", "figure"}, {"data-key", key}, {"data-value", core::to_text(value)}}, text);
}

} // namespace fettle::draw
