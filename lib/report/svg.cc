#include "report/svg.h"

#include "compare/ticks.h"
#include "report/figures.h"

#include <cmath>
#include <cstdio>

namespace fettle::svg {
namespace {

using Eigen::Vector2d;

/// Round values within an axis, and the decimals they need.
struct Ticks {
    double step;
    int decimals;
    long first, last; ///< times step

    Ticks(const Axis& axis, int count) : step(tick_step(axis.most - axis.least, count))
    {
        constexpr double kRounding = 1e-9; // an end that is a tick is one
        decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kRounding)));
        first = static_cast<long>(std::ceil(axis.least / step - kRounding));
        last = static_cast<long>(std::floor(axis.most / step + kRounding));
    }
};

/// What follows an underscore lower, up to the next blank, and the rest back on the line.
Html with_index(const std::string& words)
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
    return lone_element("line", {{"x1", coordinate(from.x())},
                                 {"y1", coordinate(from.y())},
                                 {"x2", coordinate(to.x())},
                                 {"y2", coordinate(to.y())},
                                 {"class", style}});
}

Html box(const Vector2d& corner, const Vector2d& size, const std::string& style)
{
    return lone_element("rect", {{"x", coordinate(corner.x())},
                                 {"y", coordinate(corner.y())},
                                 {"width", coordinate(size.x())},
                                 {"height", coordinate(size.y())},
                                 {"class", style}});
}

Html path(const std::string& commands, const std::string& style)
{
    return lone_element("path", {{"d", commands}, {"class", style}});
}

Html polygon(const Eigen::Matrix2Xd& corners, const std::string& style)
{
    std::string points;
    for (const Vector2d& corner : corners.colwise())
        points += (points.empty() ? "" : " ") + coordinate(corner.x()) + "," + coordinate(corner.y());
    return lone_element("polygon", {{"points", points}, {"class", style}});
}

Html circle(const Vector2d& centre, double radius, const std::string& style)
{
    return lone_element(
        "circle",
        {{"cx", coordinate(centre.x())}, {"cy", coordinate(centre.y())}, {"r", coordinate(radius)}, {"class", style}});
}

Html text(const Vector2d& at, const std::string& words, Anchor anchor, const std::string& style)
{
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    Attributes attributes = {
        {"x", coordinate(at.x())}, {"y", coordinate(at.y())}, {"text-anchor", kAnchors[static_cast<int>(anchor)]}};
    if (!style.empty()) attributes.emplace_back("class", style);
    return element("text", attributes, with_index(words));
}

Html ticks_below(const Axis& x, double top, double bottom, int count)
{
    constexpr double kBelow = 15;
    const Ticks ticks(x, count);
    Html html;
    for (long k = ticks.first; k <= ticks.last; ++k) {
        const double at = x(double(k) * ticks.step);
        html += line({at, top}, {at, bottom}, "grid");
        html += text({at, bottom + kBelow}, fixed_text(double(k) * ticks.step, ticks.decimals), Anchor::middle);
    }
    return html;
}

Html ticks_left(const Axis& y, double left, double right, int count)
{
    constexpr double kBeside = 6, kHalfDigit = 4;
    const Ticks ticks(y, count);
    Html html;
    for (long k = ticks.first; k <= ticks.last; ++k) {
        const double at = y(double(k) * ticks.step);
        html += line({left, at}, {right, at}, "grid");
        html +=
            text({left - kBeside, at + kHalfDigit}, fixed_text(double(k) * ticks.step, ticks.decimals), Anchor::end);
    }
    return html;
}

} // namespace fettle::svg
