#include "draw/chart.h"

#include "draw/ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle::draw {

namespace {

using Align = Sheet::Align;
using Eigen::Vector2d;

constexpr Rgb kGrey = {120, 120, 120}, kFrame = {170, 170, 170}, kGrid = {228, 228, 228};
// Heights of capital letters, pixels.
constexpr double kTitle = 12, kLabel = 9.5, kSmall = 8.5;
// Margins around the frame, pixels: numbers and label left, title above, numbers and label below, legend right.
constexpr double kPlotLeft = 64, kPlotTop = 46, kPlotBottom = 48, kPlotRight = 170;
// Margin between data and frame, as a share of the data's span.
constexpr double kRelativeMargin = 0.04;

struct Axis {
    double min = std::numeric_limits<double>::infinity(), max = -min;

    void include(double value)
    {
        if (!std::isfinite(value)) return;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    bool empty() const { return !(min <= max); }
    void add_margin()
    {
        const double span = max > min ? max - min : std::max(std::abs(max), 1.0);
        min -= kRelativeMargin * span;
        max += kRelativeMargin * span;
    }
    double share(double value) const { return (value - min) / (max - min); }
};

struct Frame {
    Vector2d corner, size;
    Axis x, y;

    Vector2d at(double right, double up) const
    {
        return corner + Vector2d(x.share(right) * size.x(), (1 - y.share(up)) * size.y());
    }
};

double plotted_y(const Chart& chart, double y) { return chart.logarithmic ? std::log10(y) : y; }

void draw_tick(Sheet& sheet, const Frame& frame, bool on_y, double value, const std::string& text)
{
    const Vector2d at = on_y ? frame.at(frame.x.min, value) : frame.at(value, frame.y.min);
    const Vector2d across = on_y ? Vector2d(frame.size.x(), 0) : Vector2d(0, -frame.size.y());
    sheet.line((Eigen::Matrix2d() << at, at + across).finished(), kGrid, 1);
    const Vector2d label = at + (on_y ? Vector2d(-8, 0) : Vector2d(0, 14));
    sheet.text(text, label, kSmall, kGrey, on_y ? Align::right : Align::centre);
}

void draw_linear_ticks(Sheet& sheet, const Frame& frame, bool on_y)
{
    const Axis& axis = on_y ? frame.y : frame.x;
    const double step = tick_step(axis.max - axis.min, 6);
    for (double value = std::ceil(axis.min / step) * step; value <= axis.max; value += step)
        draw_tick(sheet, frame, on_y, value, tick_text(value, step));
}

/// Ticks at 1, 2 and 5 times the powers of ten.
void draw_logarithmic_ticks(Sheet& sheet, const Frame& frame)
{
    for (double power = std::floor(frame.y.min); power <= frame.y.max; ++power)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double value = digit * std::pow(10, power), log = std::log10(value);
            if (log >= frame.y.min && log <= frame.y.max)
                draw_tick(sheet, frame, true, log, tick_text(value, std::pow(10, power)));
        }
}

void draw_curve(Sheet& sheet, const Frame& frame, const Chart& chart, const Curve& curve)
{
    constexpr double kLineWidth = 1.6, kMarkerSize = 5;
    const auto place = [&](Eigen::Index i) -> Vector2d {
        return frame.at(curve.points(0, i), plotted_y(chart, curve.points(1, i)));
    };
    for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
        if (!place(i).allFinite()) continue;
        if (curve.with_markers)
            sheet.box(place(i) - Vector2d::Constant(kMarkerSize / 2), Vector2d::Constant(kMarkerSize), curve.colour);
        if (i > 0 && place(i - 1).allFinite())
            sheet.line((Eigen::Matrix2d() << place(i - 1), place(i)).finished(), curve.colour, kLineWidth);
    }
}

void draw_legend(Sheet& sheet, const Frame& frame, const Chart& chart)
{
    constexpr double kLineHeight = 18, kSampleWidth = 16;
    Vector2d at = frame.corner + Vector2d(frame.size.x() + 12, 8);
    for (const Curve& curve : chart.curves) {
        if (curve.name.empty()) continue;
        sheet.box(at - Vector2d(0, 1.5), {kSampleWidth, 3}, curve.colour);
        sheet.text(curve.name, at + Vector2d(kSampleWidth + 6, 0), kSmall);
        at.y() += kLineHeight;
    }
}

} // namespace

Rgb curve_colour(std::size_t index)
{
    // Okabe and Ito (2008), without their yellow, which is too light for lines, and black.
    static constexpr std::array<Rgb, 6> kColours = {
        {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};
    return kColours[index % kColours.size()];
}

void draw_chart(Sheet& sheet, const Vector2d& corner, const Vector2d& size, const Chart& chart)
{
    Frame frame{corner + Vector2d(kPlotLeft, kPlotTop),
                size - Vector2d(kPlotLeft + kPlotRight, kPlotTop + kPlotBottom),
                {},
                {}};
    for (const Curve& curve : chart.curves)
        for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
            const double y = plotted_y(chart, curve.points(1, i));
            if (!std::isfinite(y)) continue;
            frame.x.include(curve.points(0, i));
            frame.y.include(y);
        }
    sheet.text(chart.title, corner + Vector2d(kPlotLeft, 14), kTitle, Sheet::kInk, Align::left, true);
    if (!frame.x.empty()) {
        frame.x.add_margin();
        frame.y.add_margin();
        draw_linear_ticks(sheet, frame, false);
        chart.logarithmic ? draw_logarithmic_ticks(sheet, frame) : draw_linear_ticks(sheet, frame, true);
        for (const Curve& curve : chart.curves) draw_curve(sheet, frame, chart, curve);
    }
    const Vector2d right(frame.size.x(), 0), down(0, frame.size.y());
    Eigen::Matrix2Xd outline(2, 4);
    outline << frame.corner, frame.corner + right, frame.corner + right + down, frame.corner + down;
    sheet.line(outline, kFrame, 1, true);
    draw_legend(sheet, frame, chart);
    sheet.text(chart.x_label, frame.corner + down + Vector2d(frame.size.x() / 2, 34), kLabel, kGrey, Align::centre);
    sheet.text(chart.y_label, frame.corner - Vector2d(0, 10), kLabel, kGrey, Align::left);
}

} // namespace fettle::draw
