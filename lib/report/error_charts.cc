#include "compare/colours.h"
#include "report/charts.h"
#include "report/figures.h"
#include "report/svg.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Eigen::Vector2d;
using svg::Anchor;

constexpr double kWidth = 720;

/// Names the two sides of zero under an axis of errors.
Html sides(const svg::Axis& x, double y)
{
    return svg::text({x.begin, y}, "\u2190 over-cut", Anchor::start, "over") +
           svg::text({x.end, y}, "material left \u2192", Anchor::end, "under");
}

/// Neighbouring bins together, so that they can be seen.
std::vector<double> joined(const std::vector<double>& counts)
{
    constexpr std::size_t kMost = 120;
    std::size_t together = (counts.size() + kMost - 1) / kMost;
    while (counts.size() % together != 0) ++together; // equally wide, and up to the limit
    std::vector<double> sums(counts.size() / together, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) sums[i / together] += counts[i];
    return sums;
}

} // namespace

Html error_gauge(const Figures& judged, double tolerance, const std::string& unit)
{
    constexpr double kHeight = 96, kTop = 26, kBar = 26, kMargin = 24, kBeyond = 1.25;
    const double least = judged.at("min"), most = judged.at("max");
    if (!std::isfinite(least) || !(tolerance > 0)) return {};
    const double limit = std::max({kBeyond * tolerance, -1.05 * least, 1.05 * most});
    const svg::Axis x = {-limit, limit, kMargin, kWidth - kMargin};
    const double bottom = kTop + kBar, middle = kTop + kBar / 2;
    Html html = svg::box({x.begin, kTop}, {x.end - x.begin, kBar}, "gauge-out");
    html += svg::box({x(-tolerance), kTop}, {x(tolerance) - x(-tolerance), kBar}, "gauge-in");
    html += svg::line({x(0), kTop}, {x(0), bottom}, "grid");
    for (const double end : {-tolerance, tolerance}) {
        html += svg::line({x(end), kTop - 6}, {x(end), bottom + 6}, "limit");
        html += svg::text({x(end), kTop - 11}, (end > 0 ? "+" : "") + short_text(end) + " " + unit, Anchor::middle);
    }
    html += svg::line({x(least), middle}, {x(most), middle}, "whisker");
    for (const double end : {least, most}) html += svg::line({x(end), middle - 7}, {x(end), middle + 7}, "whisker");
    const double p01 = judged.at("p01"), p99 = judged.at("p99");
    html += svg::box({x(p01), middle - 5}, {std::max(1.0, x(p99) - x(p01)), 10}, "spread");
    html += svg::circle({x(judged.at("mean")), middle}, 4, "mean");
    html += svg::text({x(0), bottom + 20}, "0", Anchor::middle);
    html += sides(x, bottom + 20);
    return svg::drawing(kWidth, kHeight - 18, "range of the errors between the tolerances", html);
}

Html error_histogram(const std::vector<double>& all_counts, double limit, double below, double above, double tolerance,
                     const std::string& unit)
{
    constexpr double kHeight = 250, kTop = 18, kBottom = 196, kLeft = 64, kRight = 20;
    const std::vector<double> counts = joined(all_counts);
    const double most = std::max(1.0, *std::max_element(counts.begin(), counts.end()));
    const svg::Axis x = {-limit, limit, kLeft, kWidth - kRight};
    const svg::Axis y = {0, 1.05 * most, kBottom, kTop};
    Html html = svg::ticks_below(x, kTop, kBottom, 8) + svg::ticks_left(y, x.begin, x.end, 4);
    const double width = 2 * limit / double(counts.size());
    const ColourScale scale{limit};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!(counts[i] > 0)) continue;
        const double from = -limit + width * double(i), top = std::min(y(counts[i]), kBottom - 1);
        const Rgb rgb = scale(from + width / 2);
        html += lone_element("rect", {{"x", svg::coordinate(x(from) + 0.5)},
                                      {"y", svg::coordinate(top)},
                                      {"width", svg::coordinate(x(from + width) - x(from) - 1)},
                                      {"height", svg::coordinate(kBottom - top)},
                                      {"fill", svg::colour(rgb)},
                                      {"class", "bin"}});
    }
    html += svg::line({x.begin, kBottom}, {x.end, kBottom}, "axis");
    if (tolerance > 0 && tolerance <= limit)
        for (const double end : {-tolerance, tolerance}) html += svg::line({x(end), kTop}, {x(end), kBottom}, "limit");
    html += svg::text({(x.begin + x.end) / 2, kBottom + 36}, "error, " + unit, Anchor::middle);
    html += sides(x, kBottom + 36);
    html += svg::text({x.begin, kTop - 6}, "points");
    if (below > 0) html += svg::text({x.begin + 6, kTop + 14}, "\u2190 " + count_text(below) + " beyond");
    if (above > 0) html += svg::text({x.end - 6, kTop + 14}, count_text(above) + " beyond \u2192", Anchor::end);
    return svg::drawing(kWidth, kHeight - 12, "histogram of the errors", html);
}

} // namespace fettle
