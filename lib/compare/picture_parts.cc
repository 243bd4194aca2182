#include "compare/picture_parts.h"

#include "compare/ticks.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Align = Sheet::Align;
using Eigen::Index;
using Eigen::Vector2d;

constexpr Rgb kHalo = {255, 255, 255};
constexpr Rgb kInsideEdge = {20, 20, 20}, kSamplingEdge = {120, 60, 160};

/// The axis of the machine along `way` (unit, M), "x" or "-y"; empty: none of them.
struct MachineAxis {
    std::string name;
    int index = 0;
    double sign = 1;
};
MachineAxis axis_along(const Eigen::Vector3d& way)
{
    MachineAxis axis;
    way.cwiseAbs().maxCoeff(&axis.index);
    axis.sign = way[axis.index] < 0 ? -1 : 1;
    constexpr double kSame = 1e-9; // rad: nothing of it is seen
    if ((way - axis.sign * Eigen::Vector3d::Unit(axis.index)).norm() < kSame)
        axis.name = (axis.sign < 0 ? "-" : "") + std::string(1, "xyz"[axis.index]);
    return axis;
}

/// Ticks of the axis of the machine that runs along a side of the frame. @param side  0: below, 1: left
void draw_ticks(Sheet& sheet, const Layout& layout, int side, double step, double mm)
{
    const MachineAxis axis = axis_along(layout.rotation_view_machine.row(side));
    if (axis.name.empty()) return;
    const double pixel = layout.view.pixel / mm, least = layout.view.least[side] / mm;
    const double size = side == 0 ? layout.view.columns : layout.view.rows;
    const double bottom = layout.map_corner.y() + layout.map_size.y();
    for (double value = std::ceil(least / step) * step; value <= least + size * pixel; value += step) {
        const std::string text = tick_text(axis.sign * value, step);
        const double along = (value - least) / pixel;
        if (side == 0) {
            sheet.box({layout.drawn_at.x() + along, bottom}, {0, 5}, kGrey);
            sheet.text(text, {layout.drawn_at.x() + along, bottom + 17}, kSmall, kGrey, Align::centre);
        } else {
            const double y = layout.drawn_at.y() + size - along;
            sheet.box({layout.map_corner.x() - 5, y}, {5, 0}, kGrey);
            sheet.text(text, {layout.map_corner.x() - 10, y}, kSmall, kGrey, Align::right);
        }
    }
}

/// The axes of the machine as they are seen: those that point away are paler, one that points at the eye is left out.
void draw_tripod(Sheet& sheet, const Vector2d& centre, const Eigen::Matrix3d& rotation_view_machine)
{
    constexpr double kLength = 22, kRoom = 9, kSeen = 0.2;
    constexpr Rgb kAway = {170, 170, 170};
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d way = rotation_view_machine.col(axis);
        const Vector2d on_sheet(way.x(), -way.y());
        if (on_sheet.norm() < kSeen) continue;
        const Rgb& colour = way.z() < 0 ? kAway : Sheet::kInk;
        sheet.line((Eigen::Matrix2d() << centre, centre + kLength * on_sheet).finished(), colour, 2);
        sheet.text(std::string(1, "xyz"[axis]), centre + kLength * on_sheet + kRoom * on_sheet.normalized(), kSmall,
                   colour, Align::centre);
    }
}

/// The pieces of a closed line that the part does not hide. @param corners  3xN, V
std::vector<Eigen::Matrix2Xd> seen_pieces(const Layout& layout, const Raster& part, const Eigen::Matrix3Xd& corners)
{
    // A line between corners sinks into a convex part: by that share of the picture it still counts as in front.
    constexpr double kSunk = 0.03, kStep = 2; // pixels
    const View& view = layout.view;
    const double fineness = double(part.depth.cols()) / view.columns;
    const double sunk = kSunk * view.pixel * std::max(view.columns, view.rows);
    std::vector<std::vector<Vector2d>> pieces(1);
    for (Index i = 0; i < corners.cols(); ++i) {
        const Eigen::Vector3d from = corners.col(i), to = corners.col((i + 1) % corners.cols());
        const int steps = std::max(1, static_cast<int>((to - from).head<2>().norm() / view.pixel / kStep));
        for (int k = 0; k <= steps; ++k) {
            const Eigen::Vector3d p = from + double(k) / steps * (to - from);
            const Vector2d at = view.to_pixel(p.head<2>());
            const Eigen::Array2i cell = (fineness * at).array().floor().cast<int>();
            const bool beside =
                cell.x() < 0 || cell.y() < 0 || cell.x() >= part.depth.cols() || cell.y() >= part.depth.rows();
            const bool hidden = !beside && p.z() + sunk < part.depth(cell.y(), cell.x()); // NaN hides nothing
            if (!hidden)
                pieces.back().push_back(layout.drawn_at + at);
            else if (!pieces.back().empty())
                pieces.emplace_back();
        }
    }
    std::vector<Eigen::Matrix2Xd> lines;
    for (const std::vector<Vector2d>& piece : pieces)
        if (piece.size() > 1)
            lines.emplace_back(
                Eigen::Map<const Eigen::Matrix2Xd>(piece[0].data(), 2, static_cast<Index>(piece.size())));
    return lines;
}

} // namespace

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

void draw_axes(Sheet& sheet, const Layout& layout, const Units& units)
{
    const double mm = units.mm();
    const double pixel = layout.view.pixel / mm;
    const Vector2d size(layout.view.columns, layout.view.rows);
    const Vector2d corner = layout.map_corner + layout.map_size; // lower right
    // About seven along the longer side; more, so that the shorter has two as well, but never crowded.
    const double longer = size.maxCoeff() * pixel, shorter = size.minCoeff() * pixel;
    const double step = tick_step(std::clamp(shorter / 3, longer / 16, longer / 7), 1);
    sheet.line(frame_of(layout.map_corner, layout.map_size), kFrame, 1, true);
    for (const int side : {0, 1}) draw_ticks(sheet, layout, side, step, mm);
    // The length that the eye measures with: a fifth of the map or somewhat more.
    const double length = tick_step(size.maxCoeff() * pixel, 6);
    const double y = corner.y() + 48;
    sheet.box({layout.map_corner.x(), y - 2}, {length / pixel, 4}, Sheet::kInk);
    sheet.text(number_text(length) + " " + to_string(units.length), {layout.map_corner.x() + length / pixel + 12, y},
               kLabel);
    const Eigen::Matrix3d& rotation = layout.rotation_view_machine;
    const std::string right = axis_along(rotation.row(0)).name, up = axis_along(rotation.row(1)).name;
    if (!right.empty() && !up.empty()) {
        sheet.text(right + " right, " + up + " up, " + to_string(units.length), {corner.x(), y}, kSmall, kGrey,
                   Align::right);
        return;
    }
    constexpr double kTripod = 34;
    const Eigen::Vector3d from = rotation.row(2) / rotation.row(2).cwiseAbs().maxCoeff();
    draw_tripod(sheet, {corner.x() - kTripod, y - 4}, rotation);
    sheet.text("seen from (" + number_text(from.x()) + ", " + number_text(from.y()) + ", " + number_text(from.z()) +
                   ")",
               {corner.x() - 2 * kTripod - 8, y}, kSmall, kGrey, Align::right);
}

Eigen::Matrix3Xd outline(const Eigen::Matrix3Xd& polygon)
{
    Eigen::Matrix3Xd corners = polygon;
    double sum = 0;
    Index known = 0;
    for (const double z : polygon.row(2))
        if (std::isfinite(z)) {
            sum += z;
            ++known;
        }
    for (double& z : corners.row(2))
        if (!std::isfinite(z)) z = known > 0 ? sum / double(known) : 0;
    return corners;
}

void draw_outlines(Sheet& sheet, const Layout& layout, const Raster& part, const Job& job)
{
    const bool from_above = layout.rotation_view_machine.isIdentity(0);
    const auto draw = [&](const Eigen::Matrix3Xd& polygon, const Rgb& colour, double width, const std::string& name) {
        if (polygon.cols() == 0) return;
        const Eigen::Matrix3Xd corners = in_view(layout.rotation_view_machine, outline(polygon));
        std::vector<Eigen::Matrix2Xd> lines;
        if (from_above) {
            lines.emplace_back(2, corners.cols());
            for (Index i = 0; i < corners.cols(); ++i)
                lines[0].col(i) = layout.drawn_at + layout.view.to_pixel(corners.col(i).head<2>());
        } else {
            lines = seen_pieces(layout, part, corners);
        }
        Vector2d top(0, std::numeric_limits<double>::infinity()), middle(0, 0);
        Index count = 0;
        for (const Eigen::Matrix2Xd& line : lines) {
            sheet.line(line, kHalo, width + 3, from_above); // seen on any colour
            for (const Vector2d& p : line.colwise())
                if (p.y() < top.y()) top = p;
            middle += line.rowwise().sum();
            count += line.cols();
        }
        for (const Eigen::Matrix2Xd& line : lines) sheet.line(line, colour, width, from_above);
        if (lines.empty()) return;
        constexpr double kBeside = 13;
        const bool room = top.y() - kBeside > layout.map_corner.y() + kLabel;
        const Vector2d inwards = (middle / double(count) - top).normalized();
        Vector2d at = top + kBeside * (room ? Vector2d(0, -1) : inwards);
        const double left = layout.map_corner.x() + kLabel; // not across the frame
        at.x() = std::clamp(at.x(), left, left + layout.map_size.x() - 2 * kLabel);
        sheet.text(name, at, kLabel, colour, Align::centre, true);
    };
    draw(job.sampling, kSamplingEdge, 1, "S");
    draw(job.anomaly, kInsideEdge, 2, "B");
}

} // namespace fettle
