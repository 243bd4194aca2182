#include "draw/colours.h"
#include "draw/figures.h"
#include "draw/svg.h"
#include "report/charts.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

using draw::svg::Anchor;
using Eigen::Vector2d;

constexpr double kWidth = 720;

/// Labels of the two signs of the error, below its axis.
draw::Html sign_labels(const draw::svg::Axis& x, double y)
{
    return draw::svg::text({x.begin, y}, "\u2190 over-cut", Anchor::start, "over") +
           draw::svg::text({x.end, y}, "material left \u2192", Anchor::end, "under");
}

/// Merges adjacent bins so that they are wide enough to be visible.
std::vector<double> merged_bins(const std::vector<double>& counts)
{
    constexpr std::size_t kMaxBins = 120;
    std::size_t factor = (counts.size() + kMaxBins - 1) / kMaxBins;
    while (counts.size() % factor != 0) ++factor; // all bins have the same width
    std::vector<double> sums(counts.size() / factor, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) sums[i / factor] += counts[i];
    return sums;
}

} // namespace

draw::Html error_gauge(const NamedNumbers& judged, double tolerance, const std::string& unit)
{
    constexpr double kHeight = 96, kTop = 26, kBar = 26, kMargin = 24, kRangePerTolerance = 1.25;
    const double min = judged.at("min"), max = judged.at("max");
    if (!std::isfinite(min) || !(tolerance > 0)) return {};
    const double limit = std::max({kRangePerTolerance * tolerance, -1.05 * min, 1.05 * max});
    const draw::svg::Axis x = {-limit, limit, kMargin, kWidth - kMargin};
    const double bottom = kTop + kBar, middle = kTop + kBar / 2;
    draw::Html html = draw::svg::box({x.begin, kTop}, {x.end - x.begin, kBar}, "gauge-out");
    html += draw::svg::box({x(-tolerance), kTop}, {x(tolerance) - x(-tolerance), kBar}, "gauge-in");
    html += draw::svg::line({x(0), kTop}, {x(0), bottom}, "grid");
    constexpr double kLabelWidth = 110; // pixels; closer limits share a label
    const bool are_close = x(tolerance) - x(-tolerance) < kLabelWidth;
    for (const double end : {-tolerance, tolerance}) {
        html += draw::svg::line({x(end), kTop - 6}, {x(end), bottom + 6}, "limit");
        if (!are_close)
            html += draw::svg::text({x(end), kTop - 11}, (end > 0 ? "+" : "") + draw::short_text(end) + " " + unit,
                                    Anchor::middle);
    }
    if (are_close)
        html += draw::svg::text({x(0), kTop - 11}, "\u00B1" + draw::short_text(tolerance) + " " + unit, Anchor::middle);
    html += draw::svg::line({x(min), middle}, {x(max), middle}, "whisker");
    for (const double end : {min, max}) html += draw::svg::line({x(end), middle - 7}, {x(end), middle + 7}, "whisker");
    const double p01 = judged.at("p01"), p99 = judged.at("p99");
    html += draw::svg::box({x(p01), middle - 5}, {std::max(1.0, x(p99) - x(p01)), 10}, "spread");
    html += draw::svg::circle({x(judged.at("mean")), middle}, 4, "mean");
    html += draw::svg::text({x(0), bottom + 20}, "0", Anchor::middle);
    html += sign_labels(x, bottom + 20);
    return draw::svg::drawing(kWidth, kHeight - 18, "range of the errors between the tolerances", html);
}

draw::Html error_histogram(const std::vector<double>& all_counts, double limit, double below, double above,
                           double tolerance, const std::string& unit)
{
    constexpr double kHeight = 250, kTop = 18, kBottom = 196, kLeft = 64, kRight = 20;
    const std::vector<double> counts = merged_bins(all_counts);
    const double max_count = std::max(1.0, *std::ranges::max_element(counts));
    const draw::svg::Axis x = {-limit, limit, kLeft, kWidth - kRight};
    const draw::svg::Axis y = {0, 1.05 * max_count, kBottom, kTop};
    draw::Html html = draw::svg::ticks_below(x, kTop, kBottom, 8) + draw::svg::ticks_left(y, x.begin, x.end, 4);
    const double width = 2 * limit / double(counts.size());
    const draw::ColourScale scale{limit};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!(counts[i] > 0)) continue;
        const double from = -limit + width * double(i), top = std::min(y(counts[i]), kBottom - 1);
        const draw::Rgb rgb = scale(from + width / 2);
        html += draw::empty_element("rect", {{"x", draw::svg::coordinate(x(from) + 0.5)},
                                             {"y", draw::svg::coordinate(top)},
                                             {"width", draw::svg::coordinate(x(from + width) - x(from) - 1)},
                                             {"height", draw::svg::coordinate(kBottom - top)},
                                             {"fill", draw::svg::colour(rgb)},
                                             {"class", "bin"}});
    }
    html += draw::svg::line({x.begin, kBottom}, {x.end, kBottom}, "axis");
    if (tolerance > 0 && tolerance <= limit)
        for (const double end : {-tolerance, tolerance})
            html += draw::svg::line({x(end), kTop}, {x(end), kBottom}, "limit");
    html += draw::svg::text({(x.begin + x.end) / 2, kBottom + 36}, "error, " + unit, Anchor::middle);
    html += sign_labels(x, kBottom + 36);
    html += draw::svg::text({x.begin, kTop - 6}, "points");
    if (below > 0) html += draw::svg::text({x.begin + 6, kTop + 14}, "\u2190 " + draw::count_text(below) + " beyond");
    if (above > 0)
        html += draw::svg::text({x.end - 6, kTop + 14}, draw::count_text(above) + " beyond \u2192", Anchor::end);
    return draw::svg::drawing(kWidth, kHeight - 12, "histogram of the errors", html);
}

} // namespace fettle::report
