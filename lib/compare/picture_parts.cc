#include "compare/picture_parts.h"

#include "compare/statistics.h"
#include "compare/ticks.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Align = Canvas::Align;
using Eigen::Index;
using Eigen::Vector2d;

constexpr Rgb kGrey = {120, 120, 120}, kFrame = {170, 170, 170}, kHalo = {255, 255, 255};
constexpr Rgb kInsideEdge = {20, 20, 20}, kSamplingEdge = {120, 60, 160};

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

/// Four digits that matter.
std::string number_text(double value)
{
    if (std::isnan(value)) return "-";
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.3g", value == 0 ? 0.0 : value);
    return buffer;
}

Eigen::Matrix2Xd frame_of(const Vector2d& corner, const Vector2d& size)
{
    Eigen::Matrix2Xd frame(2, 4);
    frame << corner.x(), corner.x() + size.x(), corner.x() + size.x(), corner.x(), //
        corner.y(), corner.y(), corner.y() + size.y(), corner.y() + size.y();
    return frame;
}

/// Corners of a job's polygon in M.
Eigen::Matrix2Xd in_machine(const Job& job, const Polygon& polygon)
{
    return rotation_working_machine(job.theta).transpose() * polygon;
}

} // namespace

Rgb Scale::operator()(double value) const
{
    if (std::isnan(value)) return kUndefinedColour;
    double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
    if (bands > 0) share = (std::min(std::floor(share * bands), bands - 1.0) + 0.5) / bands;
    return diverging ? ColourScale{1}(2 * share - 1) : sequential(share);
}
void draw_axes(Canvas& sheet, const Layout& layout, const Units& units)
{
    const double mm = units.mm();
    const double pixel = layout.view.pixel / mm;
    const Vector2d origin = layout.view.least / mm;
    const Vector2d size(layout.view.columns, layout.view.rows);
    const double bottom = layout.map_corner.y() + layout.map_size.y();
    // About seven along the longer side; more, so that the shorter has two as well, but never crowded.
    const double longer = size.maxCoeff() * pixel, shorter = size.minCoeff() * pixel;
    const double step = tick_step(std::clamp(shorter / 3, longer / 16, longer / 7), 1);
    sheet.line(frame_of(layout.map_corner, layout.map_size), kFrame, 1, true);
    for (double x = std::ceil(origin.x() / step) * step; x <= origin.x() + size.x() * pixel; x += step) {
        const double at = layout.drawn_at.x() + (x - origin.x()) / pixel;
        sheet.box({at, bottom}, {0, 5}, kGrey);
        sheet.text(tick_text(x, step), {at, bottom + 17}, kSmall, kGrey, Align::centre);
    }
    for (double y = std::ceil(origin.y() / step) * step; y <= origin.y() + size.y() * pixel; y += step) {
        const double at = layout.drawn_at.y() + size.y() - (y - origin.y()) / pixel;
        sheet.box({layout.map_corner.x() - 5, at}, {5, 0}, kGrey);
        sheet.text(tick_text(y, step), {layout.map_corner.x() - 10, at}, kSmall, kGrey, Align::right);
    }
    // The length that the eye measures with: a fifth of the map or somewhat more.
    const double length = tick_step(size.maxCoeff() * pixel, 6);
    const double y = bottom + 48;
    sheet.box({layout.map_corner.x(), y - 2}, {length / pixel, 4}, Canvas::kInk);
    sheet.text(number_text(length) + " " + to_string(units.length), {layout.map_corner.x() + length / pixel + 12, y},
               kLabel);
    sheet.text("x right, y up, " + to_string(units.length), {layout.map_corner.x() + layout.map_size.x(), y}, kSmall,
               kGrey, Align::right);
}

void draw_outlines(Canvas& sheet, const Layout& layout, const Job& job)
{
    const Boundaries polygons = boundaries(job);
    const auto draw = [&](const Polygon& polygon, const Rgb& colour, double width, const std::string& name) {
        if (polygon.cols() == 0) return;
        const Eigen::Matrix2Xd corners = in_machine(job, polygon);
        Eigen::Matrix2Xd path(2, corners.cols());
        Index top = 0;
        for (Index i = 0; i < corners.cols(); ++i) {
            path.col(i) = layout.drawn_at + layout.view.to_pixel(corners.col(i));
            if (path(1, i) < path(1, top)) top = i;
        }
        sheet.line(path, kHalo, width + 3, true); // seen on any colour
        sheet.line(path, colour, width, true);
        sheet.text(name, Vector2d(path.col(top)) + Vector2d(0, -13), kLabel, colour, Align::centre, true);
    };
    draw(polygons.sampling, kSamplingEdge, 1, "S");
    draw(polygons.anomaly, kInsideEdge, 2, "B");
}

void draw_legend(Canvas& sheet, const Layout& layout, const Values& values, const Scale& scale)
{
    const double x = layout.map_corner.x() + layout.map_size.x() + 40;
    const double top = layout.map_corner.y() + 46, height = layout.map_size.y() - 92;
    constexpr double kBar = 22, kTicks = 70, kHistogram = 150;
    const auto row_of = [&](double value) { return top + height * (scale.high - value) / (scale.high - scale.low); };
    sheet.text(values.name + (values.unit.empty() ? "" : ", " + values.unit), {x, layout.map_corner.y() + 4}, kLabel,
               Canvas::kInk, Align::left, true);
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
        sheet.text("material left", {x, top - 18}, kSmall, kGrey);
        sheet.text("over-cut", {x, top + height + 18}, kSmall, kGrey);
    }

    constexpr int kBins = 60;
    Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(kBins);
    for (const double value : values.numbers)
        if (std::isfinite(value))
            counts[std::clamp(static_cast<int>((value - scale.low) / (scale.high - scale.low) * kBins), 0,
                              kBins - 1)] += 1;
    const double room = kHistogram;
    const double left = x + kBar + kTicks;
    for (int bin = 0; bin < kBins; ++bin) {
        const double value = scale.low + (bin + 0.5) / kBins * (scale.high - scale.low);
        const double above = std::round(row_of(value) - height / kBins / 2),
                     below = std::round(row_of(value) + height / kBins / 2);
        const double length = counts.maxCoeff() > 0 ? room * counts[bin] / counts.maxCoeff() : 0;
        Rgb colour = scale(value);
        for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(0.9 * c); // the palest is still seen on white
        if (counts[bin] > 0) sheet.box({left, above}, {std::max(1.0, length), below - above - 2}, colour);
    }
    sheet.box({left - 1, top}, {0, height}, kFrame);
}

void draw_numbers(Canvas& sheet, const Layout& layout, const Values& values, const std::string& place)
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
    const double y = layout.map_corner.y() + layout.map_size.y() + 88;
    double x = layout.map_corner.x();
    const std::string head = place + (place.empty() || values.unit.empty() ? "" : ", ") + values.unit;
    if (!head.empty()) {
        sheet.text(head, {x, y}, kLabel, Canvas::kInk, Align::left, true);
        x += Canvas::text_width(head, kLabel, true) + 30;
    }
    for (const auto& [name, value] : items) {
        sheet.text(name, {x, y}, kLabel, kGrey);
        x += Canvas::text_width(name, kLabel) + 8;
        sheet.text(value, {x, y}, kLabel);
        x += Canvas::text_width(value, kLabel) + 26;
    }
}

} // namespace fettle
