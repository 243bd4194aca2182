#include "draw/picture_parts.h"
#include "draw/ticks.h"
#include "geometry/statistics.h"

#include <algorithm>
#include <cmath>

namespace fettle::draw {
namespace {

using Align = Sheet::Align;
using Eigen::Index;
using Eigen::Vector2d;

// Legend, pixels: distance from the map, widths of bar and ticks, and margin above and below for tips and names.
constexpr double kMapDistance = 40, kBarWidth = 22, kMinTicksWidth = 70, kBarMargin = 62;
// From the bar to the right end of the legend, for ticks and histogram.
constexpr double kBesideBar = 222, kMinHistogramWidth = 30, kMaxHistogramWidth = 150;
constexpr double kTickOffset = 10, kTickMargin = 12; // before and after the text of a tick

/// "1.2 % beyond", at least "< 0.1 % beyond".
std::string beyond_text(Index beyond, Index count)
{
    const double percent = 100 * double(beyond) / double(count);
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, percent < 9.95 ? "%.1f" : "%.0f", percent);
    return (percent < 0.05 ? "< 0.1" : std::string(buffer)) + " % beyond";
}

/// Colour bar.
struct Bar {
    Vector2d corner;
    double height;
    const PictureScale& scale;
    double ticks_width = kMinTicksWidth; ///< of the bar's ticks with their text

    double row_of(double value) const { return corner.y() + height * (scale.high - value) / (scale.high - scale.low); }
};

void draw_bar(Sheet& sheet, const Bar& bar)
{
    const PictureScale& scale = bar.scale;
    for (int row = 0; row < static_cast<int>(bar.height); ++row)
        sheet.box(bar.corner + Vector2d(0, row), {kBarWidth, 1},
                  scale(scale.high - (row + 0.5) / bar.height * (scale.high - scale.low)));
    sheet.line(rectangle_corners(bar.corner, {kBarWidth, bar.height}), kFrameGrey, 1, true);
    for (const auto& [value, text] : scale_ticks(scale)) {
        const Vector2d at(bar.corner.x() + kBarWidth, bar.row_of(value));
        sheet.box(at, {5, 0}, kTextGrey);
        sheet.text(text, at + Vector2d(kTickOffset, 0), kSmallCapitals);
    }
}

/// Histogram of the finite values over the scale.
struct ScaleHistogram {
    Eigen::ArrayXd bins;
    Index above = 0, below = 0, all = 0; ///< number of values
};

ScaleHistogram scale_histogram(const Eigen::VectorXd& numbers, const PictureScale& scale)
{
    constexpr int kBins = 60;
    ScaleHistogram counts;
    counts.bins = Eigen::ArrayXd::Zero(kBins);
    // The ends belong to the scale, up to the rounding of float fields.
    const double rounding = 1e-6 * std::max(std::abs(scale.low), std::abs(scale.high));
    for (const double value : numbers) {
        if (!std::isfinite(value)) continue;
        ++counts.all;
        if (value > scale.high + rounding)
            ++counts.above;
        else if (value < scale.low - rounding)
            ++counts.below;
        else
            counts.bins[std::clamp(static_cast<int>((value - scale.low) / (scale.high - scale.low) * kBins), 0,
                                   kBins - 1)] += 1;
    }
    return counts;
}

/// Draws a bar that does not fit, broken, with what it stands for behind it.
void draw_broken_bar(Sheet& sheet, const Vector2d& corner, double length, double height, const Rgb& colour,
                     const std::string& words)
{
    constexpr double kBreak = 4, kBehindBreak = 8, kTextGap = 6;
    sheet.box(corner, {length, height}, colour);
    sheet.box(corner + Vector2d(length + kBreak, 0), {kBehindBreak, height}, colour);
    sheet.text(words, corner + Vector2d(length + kBreak + kBehindBreak + kTextGap, height / 2), kSmallCapitals,
               kTextGrey);
}

/// Draws the bins as bars beside the colour bar. Where one bin has most values, as that of the sound metal in a map of
/// what stands on it, its bar is broken and its share of all values written, so that the others can be read.
void draw_histogram(Sheet& sheet, const Bar& bar, const ScaleHistogram& counts)
{
    constexpr double kMaxOverNext = 5;                      // from there the longest bar is broken
    constexpr double kNextLength = 0.5, kBreakLength = 0.6; // of the width: the next bar, and the longest to its break
    const double left = bar.corner.x() + kBarWidth + bar.ticks_width,
                 half = bar.height / double(counts.bins.size()) / 2;
    const double width = std::clamp(kBesideBar - bar.ticks_width, kMinHistogramWidth, kMaxHistogramWidth);
    Index longest = 0;
    const double max = counts.bins.maxCoeff(&longest);
    Eigen::ArrayXd others = counts.bins;
    others[longest] = 0;
    const double next = others.maxCoeff();
    const bool is_broken = next > 0 && max > kMaxOverNext * next;
    const double scale = is_broken ? kNextLength * width / next : width / max;
    for (Index i = 0; i < counts.bins.size(); ++i) {
        if (!(counts.bins[i] > 0)) continue;
        const double value = std::lerp(bar.scale.low, bar.scale.high, (double(i) + 0.5) / double(counts.bins.size()));
        const double upper = std::round(bar.row_of(value) - half), lower = std::round(bar.row_of(value) + half);
        Rgb colour = bar.scale(value);
        for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(0.9 * c); // keeps the palest visible on white
        if (is_broken && i == longest)
            draw_broken_bar(sheet, {left, upper}, std::round(kBreakLength * width), lower - upper - 2, colour,
                            std::to_string(std::lround(100 * max / double(counts.all))) + " %");
        else
            sheet.box({left, upper}, {std::max(1.0, scale * counts.bins[i]), lower - upper - 2}, colour);
    }
    sheet.box({left - 1, bar.corner.y()}, {0, bar.height}, kFrameGrey);
}

/// Draws a tip at an end of the bar if values lie beyond it, with their share of those in the statistics.
/// @param shown  whether the map shows any
void draw_end(Sheet& sheet, const Bar& bar, bool upper, Index beyond, Index all, bool shown)
{
    if (beyond == 0 && !shown) return;
    constexpr int kTipHeight = 14;
    const Vector2d middle(bar.corner.x() + kBarWidth / 2, bar.corner.y() + (upper ? -2 : bar.height + 3));
    for (int row = 0; row < kTipHeight; ++row) {
        const double half = kBarWidth / 2 * (1 - (row + 0.5) / kTipHeight);
        sheet.box(middle + Vector2d(-half, upper ? -row - 1 : row), {2 * half, 1},
                  bar.scale(upper ? bar.scale.high : bar.scale.low));
    }
    sheet.text(beyond > 0 ? beyond_text(beyond, all) : "some beyond",
               {bar.corner.x() + kBarWidth + bar.ticks_width, middle.y() + (upper ? -10 : 10)}, kSmallCapitals,
               kTextGrey);
}

void draw_classes(Sheet& sheet, const Vector2d& corner, const std::vector<FieldClass>& classes)
{
    constexpr double kSwatch = 16, kFirst = 40, kDistance = 30, kCountColumn = 230;
    Vector2d at = corner + Vector2d(0, kFirst);
    for (const FieldClass& found : classes) {
        sheet.box(at - Vector2d(0, kSwatch / 2), {kSwatch, kSwatch}, found.colour);
        sheet.line(rectangle_corners(at - Vector2d(0, kSwatch / 2), {kSwatch, kSwatch}), kFrameGrey, 1, true);
        sheet.text(found.name, at + Vector2d(kSwatch + 10, 0), kLabelCapitals);
        sheet.text(std::to_string(found.count), at + Vector2d(kCountColumn, 0), kLabelCapitals, kTextGrey,
                   Align::right);
        at.y() += kDistance;
    }
}

} // namespace

std::vector<std::pair<double, std::string>> scale_ticks(const PictureScale& scale)
{
    std::vector<std::pair<double, std::string>> ticks;
    const double step = tick_step(scale.high - scale.low, 8);
    for (double k = std::ceil(scale.low / step - 1e-9); k * step <= scale.high + 1e-9 * step; ++k)
        ticks.emplace_back(k * step, (scale.diverging && k > 0.5 ? "+" : "") + tick_text(k * step, step));
    return ticks;
}

void draw_legend(Sheet& sheet, const Layout& layout, const PictureValues& values, const PictureScale& scale)
{
    const Vector2d corner = layout.map_corner + Vector2d(layout.map_size.x() + kMapDistance, 0);
    Bar bar = {corner + Vector2d(0, kBarMargin), layout.map_size.y() - 2 * kBarMargin, scale};
    for (const auto& [value, text] : scale_ticks(scale))
        bar.ticks_width = std::max(bar.ticks_width, kTickOffset + sheet.text_width(text, kSmallCapitals) + kTickMargin);
    sheet.text(values.name + (values.unit.empty() ? "" : ", " + values.unit), corner + Vector2d(0, 4), kLabelCapitals,
               Sheet::kInk, Align::left, true);
    if (scale.packed) return;
    if (!scale.classes.empty()) {
        draw_classes(sheet, corner, scale.classes);
        return;
    }
    if (scale.diverging) {
        sheet.text("material left", corner + Vector2d(0, 28), kSmallCapitals, kTextGrey);
        sheet.text("over-cut", corner + Vector2d(0, layout.map_size.y() - 28), kSmallCapitals, kTextGrey);
    }
    draw_bar(sheet, bar);
    // The map of a mesh from the side shows other points than its statistics, so values may lie slightly beyond.
    constexpr double kRelativeTolerance = 0.01;
    const double tolerance = kRelativeTolerance * (scale.high - scale.low);
    const ScaleHistogram counts = scale_histogram(values.numbers, scale);
    draw_histogram(sheet, bar, counts);
    draw_end(sheet, bar, true, counts.above, counts.all, values.max_shown > scale.high + tolerance);
    draw_end(sheet, bar, false, counts.below, counts.all, values.min_shown < scale.low - tolerance);
}

void draw_numbers(Sheet& sheet, const Layout& layout, const PictureValues& values, const std::string& region)
{
    const geometry::Statistics s =
        geometry::statistics(values.numbers, Eigen::VectorXd::Zero(values.numbers.size()), std::nullopt);
    // Numbers below this share of the largest are shown as 0: rounding.
    constexpr double kMinRelative = 1e-4;
    const double largest = std::max(std::abs(s.min), std::abs(s.max));
    // Of a narrow range far from 0, as of heights after grinding, the same three digits would stand for every number.
    constexpr double kRangeShare = 0.1;
    const auto text = [&](double value) {
        return number_text(std::abs(value) < kMinRelative * largest ? 0 : value, kRangeShare * (s.max - s.min));
    };
    std::vector<std::pair<std::string, std::string>> items = {{"mean", text(s.mean)}};
    if (values.name == "error") items.insert(items.end(), {{"mean |error|", text(s.mean_abs)}, {"rms", text(s.rms)}});
    items.insert(items.end(), {{"min", text(s.min)}, {"max", text(s.max)}});
    items.insert(items.end(), {{values.counted, std::to_string(s.count)}, {"undefined", std::to_string(s.undefined)}});
    // One line, or two on a narrow sheet.
    constexpr double kBelowMapOffset = 88, kLineHeight = 22, kLegendColumn = 290;
    const double right = layout.map_corner.x() + layout.map_size.x() + kLegendColumn;
    Vector2d at = layout.map_corner + Vector2d(0, layout.map_size.y() + kBelowMapOffset);
    const std::string head = region + (region.empty() || values.unit.empty() ? "" : ", ") + values.unit;
    if (!head.empty()) {
        sheet.text(head, at, kLabelCapitals, Sheet::kInk, Align::left, true);
        at.x() += sheet.text_width(head, kLabelCapitals, true) + 30;
    }
    for (const auto& [name, value] : items) {
        constexpr double kSwatch = 12, kGap = 8, kItemGap = 26;
        const bool with_swatch = name == "undefined" && s.undefined > 0;
        const double name_width = sheet.text_width(name, kLabelCapitals),
                     value_width = sheet.text_width(value, kLabelCapitals);
        if (at.x() + name_width + kGap + value_width + (with_swatch ? kSwatch + kGap : 0) > right)
            at = Vector2d(layout.map_corner.x(), at.y() + kLineHeight);
        if (with_swatch) {
            sheet.box(at - Vector2d(0, kSwatch / 2), {kSwatch, kSwatch}, kUndefinedColour);
            at.x() += kSwatch + kGap;
        }
        sheet.text(name, at, kLabelCapitals, kTextGrey);
        at.x() += name_width + kGap;
        sheet.text(value, at, kLabelCapitals);
        at.x() += value_width + kItemGap;
    }
}

} // namespace fettle::draw
