#include "compare/picture_parts.h"
#include "compare/statistics.h"
#include "compare/ticks.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Align = Sheet::Align;
using Eigen::Index;
using Eigen::Vector2d;

// YlGnBu of ColorBrewer (Cynthia Brewer, Apache-2.0) without its palest and its darkest two: evenly darker, plain to
// every eye, and light enough for shades.
constexpr std::array<Rgb, 6> kSequential = {
    {{237, 248, 177}, {199, 233, 180}, {127, 205, 187}, {65, 182, 196}, {29, 145, 192}, {34, 94, 168}}};

Rgb sequential(double share)
{
    const double place = std::clamp(share, 0.0, 1.0) * (kSequential.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kSequential.size() - 2);
    Rgb mixed;
    for (std::size_t i = 0; i < 3; ++i)
        mixed[i] = static_cast<std::uint8_t>(
            std::lround(std::lerp(kSequential[below][i], kSequential[below + 1][i], place - double(below))));
    return mixed;
}

/// Above the bar or below it: a tip where values lie beyond its end.
void draw_tip(Sheet& sheet, const Vector2d& middle, double width, double height, const Rgb& colour)
{
    const int rows = static_cast<int>(std::abs(height));
    for (int row = 0; row < rows; ++row) {
        const double half = width / 2 * (1 - (row + 0.5) / rows);
        sheet.box(middle + Vector2d(-half, height < 0 ? -row - 1 : row), {2 * half, 1}, colour);
    }
}

/// "1.2 % beyond", never 0 where there are some.
std::string beyond_text(Index beyond, Index count)
{
    const double percent = 100 * double(beyond) / double(count);
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, percent < 9.95 ? "%.1f" : "%.0f", percent);
    return (percent < 0.05 ? "< 0.1" : std::string(buffer)) + " % beyond";
}

} // namespace

Rgb Scale::operator()(double value) const
{
    if (std::isnan(value)) return kUndefinedColour;
    double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
    if (bands > 0) share = (std::min(std::floor(share * bands), bands - 1.0) + 0.5) / bands;
    return diverging ? ColourScale{1}(2 * share - 1) : sequential(share);
}

void draw_legend(Sheet& sheet, const Layout& layout, const Values& values, const Scale& scale)
{
    // The bar, with room above and below for its tips and names.
    constexpr double kBar = 22, kTicks = 70, kHistogram = 150, kRoom = 62, kTip = 14;
    const double x = layout.map_corner.x() + layout.map_size.x() + 40;
    const double top = layout.map_corner.y() + kRoom, height = layout.map_size.y() - 2 * kRoom;
    const auto row_of = [&](double value) { return top + height * (scale.high - value) / (scale.high - scale.low); };
    sheet.text(values.name + (values.unit.empty() ? "" : ", " + values.unit), {x, layout.map_corner.y() + 4}, kLabel,
               Sheet::kInk, Align::left, true);
    for (int row = 0; row < static_cast<int>(height); ++row)
        sheet.box({x, top + row}, {kBar, 1}, scale(scale.high - (row + 0.5) / height * (scale.high - scale.low)));
    sheet.line(frame_of({x, top}, {kBar, height}), kFrame, 1, true);
    const double step = tick_step(scale.high - scale.low, 8);
    for (double k = std::ceil(scale.low / step - 1e-9); k * step <= scale.high + 1e-9 * step; ++k) {
        const double at = row_of(k * step);
        sheet.box({x + kBar, at}, {5, 0}, kGrey);
        const std::string sign = scale.diverging && k > 0.5 ? "+" : "";
        sheet.text(sign + tick_text(k * step, step), {x + kBar + 10, at}, kSmall);
    }
    if (scale.diverging) {
        sheet.text("material left", {x, layout.map_corner.y() + 28}, kSmall, kGrey);
        sheet.text("over-cut", {x, top + height + kRoom - 28}, kSmall, kGrey);
    }

    constexpr int kBins = 60;
    Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(kBins);
    Index above = 0, below = 0, count = 0;
    // The ends belong to the scale, to the rounding of float fields.
    const double rounding = 1e-6 * std::max(std::abs(scale.low), std::abs(scale.high));
    for (const double value : values.numbers) {
        if (!std::isfinite(value)) continue;
        ++count;
        if (value > scale.high + rounding)
            ++above;
        else if (value < scale.low - rounding)
            ++below;
        else
            counts[std::clamp(static_cast<int>((value - scale.low) / (scale.high - scale.low) * kBins), 0,
                              kBins - 1)] += 1;
    }
    const double left = x + kBar + kTicks;
    for (int bin = 0; bin < kBins; ++bin) {
        const double value = scale.low + (bin + 0.5) / kBins * (scale.high - scale.low);
        const double upper = std::round(row_of(value) - height / kBins / 2),
                     lower = std::round(row_of(value) + height / kBins / 2);
        const double length = counts.maxCoeff() > 0 ? kHistogram * counts[bin] / counts.maxCoeff() : 0;
        Rgb colour = scale(value);
        for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(0.9 * c); // the palest is still seen on white
        if (counts[bin] > 0) sheet.box({left, upper}, {std::max(1.0, length), lower - upper - 2}, colour);
    }
    sheet.box({left - 1, top}, {0, height}, kFrame);
    const Vector2d end(x + kBar / 2, top + height + 1);
    if (above > 0) {
        draw_tip(sheet, {end.x(), top - 2}, kBar, -kTip, scale(scale.high));
        sheet.text(beyond_text(above, count), {left, top - 12}, kSmall, kGrey);
    }
    if (below > 0) {
        draw_tip(sheet, end + Vector2d(0, 2), kBar, kTip, scale(scale.low));
        sheet.text(beyond_text(below, count), {left, end.y() + 12}, kSmall, kGrey);
    }
}

void draw_numbers(Sheet& sheet, const Layout& layout, const Values& values, const std::string& place)
{
    const Statistics s = statistics(values.numbers, Eigen::VectorXd::Zero(values.numbers.size()), std::nullopt);
    // What is rounding beside the largest number is shown as 0.
    constexpr double kNothing = 1e-4;
    const double largest = std::max(std::abs(s.min), std::abs(s.max));
    const auto text = [&](double value) { return number_text(std::abs(value) < kNothing * largest ? 0 : value); };
    std::vector<std::pair<std::string, std::string>> items = {{"mean", text(s.mean)}};
    if (values.name == "error") items.insert(items.end(), {{"mean |error|", text(s.mean_abs)}, {"rms", text(s.rms)}});
    items.insert(items.end(), {{"min", text(s.min)}, {"max", text(s.max)}});
    items.insert(items.end(), {{"points", std::to_string(s.count)}, {"undefined", std::to_string(s.undefined)}});
    // One line, or two on a narrow sheet.
    constexpr double kBelow = 88, kLine = 22, kBesideMap = 290;
    const double right = layout.map_corner.x() + layout.map_size.x() + kBesideMap;
    Vector2d at = layout.map_corner + Vector2d(0, layout.map_size.y() + kBelow);
    const std::string head = place + (place.empty() || values.unit.empty() ? "" : ", ") + values.unit;
    if (!head.empty()) {
        sheet.text(head, at, kLabel, Sheet::kInk, Align::left, true);
        at.x() += sheet.text_width(head, kLabel, true) + 30;
    }
    for (const auto& [name, value] : items) {
        constexpr double kSwatch = 12, kGap = 8, kApart = 26;
        const bool key = name == "undefined" && s.undefined > 0; // of the grey places
        const double name_width = sheet.text_width(name, kLabel), value_width = sheet.text_width(value, kLabel);
        if (at.x() + name_width + kGap + value_width + (key ? kSwatch + kGap : 0) > right)
            at = Vector2d(layout.map_corner.x(), at.y() + kLine);
        if (key) {
            sheet.box(at - Vector2d(0, kSwatch / 2), {kSwatch, kSwatch}, kUndefinedColour);
            at.x() += kSwatch + kGap;
        }
        sheet.text(name, at, kLabel, kGrey);
        at.x() += name_width + kGap;
        sheet.text(value, at, kLabel);
        at.x() += value_width + kApart;
    }
}

} // namespace fettle
