#include "compare/chart.h"

#include "compare/ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Align = Sheet::Align;
using Eigen::Vector2d;

constexpr Rgb kGrey = {120, 120, 120}, kFrame = {170, 170, 170}, kGrid = {228, 228, 228};
// Heights of capital letters, pixels.
constexpr double kTitle = 12, kLabel = 9.5, kSmall = 8.5;
// Room around the frame, pixels: numbers and label left, title above, numbers and label below, key right.
constexpr double kLeft = 64, kAbove = 46, kBelow = 48, kRight = 170;
// Data keep that share of the span off the frame.
constexpr double kMargin = 0.04;

struct Axis {
    double least = std::numeric_limits<double>::infinity(), most = -least;

    void take(double value)
    {
        if (!std::isfinite(value)) return;
        least = std::min(least, value);
        most = std::max(most, value);
    }
    bool empty() const { return !(least <= most); }
    void widen()
    {
        const double span = most > least ? most - least : std::max(std::abs(most), 1.0);
        least -= kMargin * span;
        most += kMargin * span;
    }
    double share(double value) const { return (value - least) / (most - least); }
};

struct Frame {
    Vector2d corner, size;
    Axis x, y;

    Vector2d at(double right, double up) const
    {
        return corner + Vector2d(x.share(right) * size.x(), (1 - y.share(up)) * size.y());
    }
};

double shown(const Chart& chart, double y) { return chart.logarithmic ? std::log10(y) : y; }

void draw_tick(Sheet& sheet, const Frame& frame, bool upright, double value, const std::string& text)
{
    const Vector2d at = upright ? frame.at(frame.x.least, value) : frame.at(value, frame.y.least);
    const Vector2d across = upright ? Vector2d(frame.size.x(), 0) : Vector2d(0, -frame.size.y());
    sheet.line((Eigen::Matrix2d() << at, at + across).finished(), kGrid, 1);
    const Vector2d beside = at + (upright ? Vector2d(-8, 0) : Vector2d(0, 14));
    sheet.text(text, beside, kSmall, kGrey, upright ? Align::right : Align::centre);
}

void draw_linear_ticks(Sheet& sheet, const Frame& frame, bool upright)
{
    const Axis& axis = upright ? frame.y : frame.x;
    const double step = tick_step(axis.most - axis.least, 6);
    for (double value = std::ceil(axis.least / step) * step; value <= axis.most; value += step)
        draw_tick(sheet, frame, upright, value, tick_text(value, step));
}

/// 1, 2 and 5 times the powers of ten.
void draw_logarithmic_ticks(Sheet& sheet, const Frame& frame)
{
    for (double power = std::floor(frame.y.least); power <= frame.y.most; ++power)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double value = digit * std::pow(10, power), place = std::log10(value);
            if (place >= frame.y.least && place <= frame.y.most)
                draw_tick(sheet, frame, true, place, tick_text(value, std::pow(10, power)));
        }
}

void draw_curve(Sheet& sheet, const Frame& frame, const Chart& chart, const Curve& curve)
{
    constexpr double kWidth = 1.6, kMark = 5;
    const auto place = [&](Eigen::Index i) -> Vector2d {
        return frame.at(curve.points(0, i), shown(chart, curve.points(1, i)));
    };
    for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
        if (!place(i).allFinite()) continue;
        if (curve.marked) sheet.box(place(i) - Vector2d::Constant(kMark / 2), Vector2d::Constant(kMark), curve.colour);
        if (i > 0 && place(i - 1).allFinite())
            sheet.line((Eigen::Matrix2d() << place(i - 1), place(i)).finished(), curve.colour, kWidth);
    }
}

void draw_key(Sheet& sheet, const Frame& frame, const Chart& chart)
{
    constexpr double kLine = 18, kSample = 16;
    Vector2d at = frame.corner + Vector2d(frame.size.x() + 12, 8);
    for (const Curve& curve : chart.curves) {
        if (curve.name.empty()) continue;
        sheet.box(at - Vector2d(0, 1.5), {kSample, 3}, curve.colour);
        sheet.text(curve.name, at + Vector2d(kSample + 6, 0), kSmall);
        at.y() += kLine;
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
    Frame frame{corner + Vector2d(kLeft, kAbove), size - Vector2d(kLeft + kRight, kAbove + kBelow), {}, {}};
    for (const Curve& curve : chart.curves)
        for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
            const double y = shown(chart, curve.points(1, i));
            if (!std::isfinite(y)) continue;
            frame.x.take(curve.points(0, i));
            frame.y.take(y);
        }
    sheet.text(chart.title, corner + Vector2d(kLeft, 14), kTitle, Sheet::kInk, Align::left, true);
    if (!frame.x.empty()) {
        frame.x.widen();
        frame.y.widen();
        draw_linear_ticks(sheet, frame, false);
        chart.logarithmic ? draw_logarithmic_ticks(sheet, frame) : draw_linear_ticks(sheet, frame, true);
        for (const Curve& curve : chart.curves) draw_curve(sheet, frame, chart, curve);
    }
    const Vector2d right(frame.size.x(), 0), down(0, frame.size.y());
    Eigen::Matrix2Xd outline(2, 4);
    outline << frame.corner, frame.corner + right, frame.corner + right + down, frame.corner + down;
    sheet.line(outline, kFrame, 1, true);
    draw_key(sheet, frame, chart);
    sheet.text(chart.x_label, frame.corner + down + Vector2d(frame.size.x() / 2, 34), kLabel, kGrey, Align::centre);
    sheet.text(chart.y_label, frame.corner - Vector2d(0, 10), kLabel, kGrey, Align::left);
}

} // namespace fettle
