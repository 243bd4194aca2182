#include "draw/svg.h"

#include "draw/figures.h"
#include "draw/ticks.h"

#include <cmath>
#include <cstdio>

namespace fettle::draw::svg {
namespace {

using Eigen::Vector2d;

/// Ticks at round values within an axis.
struct Ticks {
    double step;
    int decimals;     ///< that the values need
    long first, last; ///< multiples of the step

    Ticks(const Axis& axis, int count) : step(tick_step(axis.max - axis.min, count))
    {
        constexpr double kRounding = 1e-9; // in steps: an end of the axis may be a tick
        decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kRounding)));
        first = static_cast<long>(std::ceil(axis.min / step - kRounding));
        last = static_cast<long>(std::floor(axis.max / step + kRounding));
    }
};

/// Sets what follows an underscore, up to the next blank, as subscript.
Html with_subscript(const std::string& words)
{
    const std::size_t underscore = words.find('_');
    if (underscore == std::string::npos) return words;
    const std::size_t blank = std::min(words.find(' ', underscore), words.size());
    constexpr const char *kDown = "3", *kUp = "-3"; // pixels
    Html html = words.substr(0, underscore);
    html += element("tspan", Attributes{{"dy", kDown}}, words.substr(underscore + 1, blank - underscore - 1));
    if (blank < words.size()) html += element("tspan", Attributes{{"dy", kUp}, {"class", "line"}}, words.substr(blank));
    return html;
}

} // namespace

std::string coordinate(double value)
{
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.2f", value);
    std::string digits = buffer;
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits == "-0" ? "0" : digits;
}

std::string coordinates(const Eigen::Matrix2Xd& points)
{
    std::string text;
    for (const Vector2d& p : points.colwise())
        text += (text.empty() ? "" : " ") + coordinate(p.x()) + "," + coordinate(p.y());
    return text;
}

std::string colour(const std::array<std::uint8_t, 3>& rgb)
{
    char buffer[8];
    std::snprintf(buffer, sizeof buffer, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    return buffer;
}

Html drawing(double width, double height, const std::string& label, const Html& content)
{
    return element("svg",
                   {{"viewBox", "0 0 " + coordinate(width) + " " + coordinate(height)},
                    {"width", coordinate(width)},
                    {"height", coordinate(height)},
                    {"role", "img"},
                    {"aria-label", label}},
                   content);
}

Html line(const Vector2d& from, const Vector2d& to, const std::string& style)
{
    return empty_element("line", {{"x1", coordinate(from.x())},
                                  {"y1", coordinate(from.y())},
                                  {"x2", coordinate(to.x())},
                                  {"y2", coordinate(to.y())},
                                  {"class", style}});
}

Html box(const Vector2d& corner, const Vector2d& size, const std::string& style)
{
    return empty_element("rect", {{"x", coordinate(corner.x())},
                                  {"y", coordinate(corner.y())},
                                  {"width", coordinate(size.x())},
                                  {"height", coordinate(size.y())},
                                  {"class", style}});
}

Html path(const std::string& commands, const std::string& style)
{
    return empty_element("path", {{"d", commands}, {"class", style}});
}

Html polygon(const Eigen::Matrix2Xd& corners, const std::string& style)
{
    return empty_element("polygon", {{"points", coordinates(corners)}, {"class", style}});
}

Html circle(const Vector2d& centre, double radius, const std::string& style)
{
    return empty_element(
        "circle",
        {{"cx", coordinate(centre.x())}, {"cy", coordinate(centre.y())}, {"r", coordinate(radius)}, {"class", style}});
}

Html text_element(const Attributes& attributes, const Html& words) { return element("text", attributes, words) + "\n"; }

Html text(const Vector2d& at, const std::string& words, Anchor anchor, const std::string& style)
{
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    Attributes attributes = {
        {"x", coordinate(at.x())}, {"y", coordinate(at.y())}, {"text-anchor", kAnchors[static_cast<int>(anchor)]}};
    if (!style.empty()) attributes.emplace_back("class", style);
    return text_element(attributes, with_subscript(words));
}

Html ticks_below(const Axis& x, double top, double bottom, int count)
{
    constexpr double kLabelOffset = 15;
    const Ticks ticks(x, count);
    Html html;
    for (long k = ticks.first; k <= ticks.last; ++k) {
        const double at = x(double(k) * ticks.step);
        html += line({at, top}, {at, bottom}, "grid");
        html += text({at, bottom + kLabelOffset}, fixed_text(double(k) * ticks.step, ticks.decimals), Anchor::middle);
    }
    return html;
}

Html ticks_left(const Axis& y, double left, double right, int count)
{
    constexpr double kLabelGap = 6, kHalfDigit = 4;
    const Ticks ticks(y, count);
    Html html;
    for (long k = ticks.first; k <= ticks.last; ++k) {
        const double at = y(double(k) * ticks.step);
        html += line({left, at}, {right, at}, "grid");
        html +=
            text({left - kLabelGap, at + kHalfDigit}, fixed_text(double(k) * ticks.step, ticks.decimals), Anchor::end);
    }
    return html;
}

} // namespace fettle::draw::svg
