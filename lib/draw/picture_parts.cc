#include "draw/picture_parts.h"

#include "draw/ticks.h"

#include <algorithm>
#include <cmath>

namespace fettle::draw {
namespace {

using Align = Sheet::Align;
using Eigen::Index;
using Eigen::Vector2d;

constexpr Rgb kHalo = {255, 255, 255};
constexpr Rgb kInsideEdge = {20, 20, 20}, kSamplingEdge = {120, 60, 160};

/// The machine axis that dominates a direction.
struct MachineAxis {
    std::string name; ///< "x", "-y", …; empty: the direction is not parallel to it
    int index = 0;
    double sign = 1;
};
MachineAxis axis_along(const Eigen::Vector3d& direction)
{
    MachineAxis axis;
    direction.cwiseAbs().maxCoeff(&axis.index);
    axis.sign = direction[axis.index] < 0 ? -1 : 1;
    constexpr double kMaxParallelAngle = 1e-9; // rad, invisible
    if ((direction - axis.sign * Eigen::Vector3d::Unit(axis.index)).norm() < kMaxParallelAngle)
        axis.name = (axis.sign < 0 ? "-" : "") + std::string(1, "xyz"[axis.index]);
    return axis;
}

/// Draws the ticks of the machine axis along a side of the frame, if any. @param side  0: below, 1: left
void draw_ticks(Sheet& sheet, const Layout& layout, int side, double step, double mm)
{
    const MachineAxis axis = axis_along(layout.rotation_view_machine.row(side));
    if (axis.name.empty()) return;
    const double pixel = layout.view.pixel / mm, min = layout.view.min_corner[side] / mm;
    const double size = side == 0 ? layout.view.columns : layout.view.rows;
    const double bottom = layout.map_corner.y() + layout.map_size.y();
    for (double value = std::ceil(min / step) * step; value <= min + size * pixel; value += step) {
        const std::string text = tick_text(axis.sign * value, step);
        const double along = (value - min) / pixel;
        if (side == 0) {
            sheet.box({layout.view_corner.x() + along, bottom}, {0, 5}, kTextGrey);
            sheet.text(text, {layout.view_corner.x() + along, bottom + 17}, kSmallCapitals, kTextGrey, Align::centre);
        } else {
            const double y = layout.view_corner.y() + size - along;
            sheet.box({layout.map_corner.x() - 5, y}, {5, 0}, kTextGrey);
            sheet.text(text, {layout.map_corner.x() - 10, y}, kSmallCapitals, kTextGrey, Align::right);
        }
    }
}

/// Draws the machine axes in the view; those that point away are paler, one along the view direction is omitted.
void draw_tripod(Sheet& sheet, const Vector2d& centre, const Eigen::Matrix3d& rotation_view_machine)
{
    constexpr double kLength = 22, kLabelDistance = 9, kMinProjection = 0.2;
    constexpr Rgb kPale = {170, 170, 170};
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d direction = rotation_view_machine.col(axis);
        const Vector2d on_sheet(direction.x(), -direction.y());
        if (on_sheet.norm() < kMinProjection) continue;
        const Rgb& colour = direction.z() < 0 ? kPale : Sheet::kInk;
        sheet.line((Eigen::Matrix2d() << centre, centre + kLength * on_sheet).finished(), colour, 2);
        sheet.text(std::string(1, "xyz"[axis]), centre + kLength * on_sheet + kLabelDistance * on_sheet.normalized(),
                   kSmallCapitals, colour, Align::centre);
    }
}

/// The pieces of a closed line that the part does not hide. @param corners  3xN, V
std::vector<Eigen::Matrix2Xd> visible_pieces(const Layout& layout, const Raster& part, const Eigen::Matrix3Xd& corners)
{
    // A line on the part, at the height of its cells, counts as visible down to this share of the picture.
    constexpr double kMaxDepthToSize = 0.03, kStepPixels = 2;
    const View& view = layout.view;
    const double fineness = double(part.depth.cols()) / view.columns;
    const double max_depth = kMaxDepthToSize * view.pixel * std::max(view.columns, view.rows);
    std::vector<std::vector<Vector2d>> pieces(1);
    for (Index i = 0; i < corners.cols(); ++i) {
        const Eigen::Vector3d from = corners.col(i), to = corners.col((i + 1) % corners.cols());
        const int steps = std::max(1, static_cast<int>((to - from).head<2>().norm() / view.pixel / kStepPixels));
        for (int k = 0; k <= steps; ++k) {
            const Eigen::Vector3d p = from + double(k) / steps * (to - from);
            const Vector2d at = view.to_pixel(p.head<2>());
            const Eigen::Array2i cell = (fineness * at).array().floor().cast<int>();
            const bool outside =
                cell.x() < 0 || cell.y() < 0 || cell.x() >= part.depth.cols() || cell.y() >= part.depth.rows();
            const bool hidden = !outside && p.z() + max_depth < part.depth(cell.y(), cell.x()); // NaN hides nothing
            if (!hidden)
                pieces.back().push_back(layout.view_corner + at);
            else if (!pieces.back().empty())
                pieces.emplace_back();
        }
    }
    std::vector<Eigen::Matrix2Xd> lines;
    for (const std::vector<Vector2d>& piece : pieces)
        if (piece.size() > 1) lines.emplace_back(Eigen::Map<const Eigen::Matrix2Xd>(piece[0].data(), 2, piece.size()));
    return lines;
}

} // namespace

std::string number_text(double value, double resolution)
{
    if (std::isnan(value)) return "-";
    if (value == 0) return "0"; // without a sign
    constexpr int kSignificantDigits = 3, kMaxSignificantDigits = 9;
    const auto place = [](double number) { return static_cast<int>(std::floor(std::log10(std::abs(number)))); };
    int digits = kSignificantDigits;
    if (resolution > 0 && std::isfinite(value))
        digits = std::clamp(place(value) - place(resolution) + 1, digits, kMaxSignificantDigits);
    // Four to six digits before the point are read more easily than an exponent.
    constexpr double kMinWhole = 999.5, kMaxWhole = 1e6;
    const bool is_whole = std::abs(value) >= kMinWhole && std::abs(value) < kMaxWhole;
    char buffer[64];
    if (is_whole && digits <= place(value) + 1)
        std::snprintf(buffer, sizeof buffer, "%.0f", value);
    else
        std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
    return buffer;
}

Eigen::Matrix2Xd rectangle_corners(const Vector2d& corner, const Vector2d& size)
{
    Eigen::Matrix2Xd frame(2, 4);
    frame << corner.x(), corner.x() + size.x(), corner.x() + size.x(), corner.x(), //
        corner.y(), corner.y(), corner.y() + size.y(), corner.y() + size.y();
    return frame;
}

void draw_axes(Sheet& sheet, const Layout& layout, const units::Units& units)
{
    const double mm = units.mm();
    const double pixel = layout.view.pixel / mm;
    const Vector2d size(layout.view.columns, layout.view.rows);
    const Vector2d corner = layout.map_corner + layout.map_size; // lower right
    // About seven ticks along the longer side, or more, up to sixteen, to give the shorter side two or three.
    const double longer = size.maxCoeff() * pixel, shorter = size.minCoeff() * pixel;
    const double step = tick_step(std::clamp(shorter / 3, longer / 16, longer / 7), 1);
    sheet.line(rectangle_corners(layout.map_corner, layout.map_size), kFrameGrey, 1, true);
    for (const int side : {0, 1}) draw_ticks(sheet, layout, side, step, mm);
    // Scale bar: a sixth of the map or somewhat more.
    const double length = tick_step(size.maxCoeff() * pixel, 6);
    const double y = corner.y() + 48;
    sheet.box({layout.map_corner.x(), y - 2}, {length / pixel, 4}, Sheet::kInk);
    sheet.text(number_text(length) + " " + units::to_string(units.length),
               {layout.map_corner.x() + length / pixel + 12, y}, kLabelCapitals);
    const Eigen::Matrix3d& rotation = layout.rotation_view_machine;
    const std::string right = axis_along(rotation.row(0)).name, up = axis_along(rotation.row(1)).name;
    if (!right.empty() && !up.empty()) {
        sheet.text(right + " right, " + up + " up, " + units::to_string(units.length), {corner.x(), y}, kSmallCapitals,
                   kTextGrey, Align::right);
        return;
    }
    constexpr double kTripod = 34;
    const Eigen::Vector3d from = rotation.row(2) / rotation.row(2).cwiseAbs().maxCoeff();
    draw_tripod(sheet, {corner.x() - kTripod, y - 4}, rotation);
    sheet.text("seen from (" + number_text(from.x()) + ", " + number_text(from.y()) + ", " + number_text(from.z()) +
                   ")",
               {corner.x() - 2 * kTripod - 8, y}, kSmallCapitals, kTextGrey, Align::right);
}

void draw_outlines(Sheet& sheet, const Layout& layout, const Raster& part, const std::vector<Outline>& outlines)
{
    const bool from_above = layout.rotation_view_machine.isIdentity(0);
    const auto draw = [&](const Eigen::Matrix3Xd& polygon, const Rgb& colour, double width, const std::string& name) {
        const Eigen::Matrix3Xd corners = in_view(layout.rotation_view_machine, polygon);
        std::vector<Eigen::Matrix2Xd> lines;
        if (from_above) {
            lines.emplace_back(2, corners.cols());
            for (Index i = 0; i < corners.cols(); ++i)
                lines[0].col(i) = layout.view_corner + layout.view.to_pixel(corners.col(i).head<2>());
        } else {
            lines = visible_pieces(layout, part, corners);
        }
        Vector2d top(0, std::numeric_limits<double>::infinity()), middle(0, 0);
        Index count = 0;
        for (const Eigen::Matrix2Xd& line : lines) {
            sheet.line(line, kHalo, width + 3, from_above); // contrasts with any colour
            for (const Vector2d& p : line.colwise())
                if (p.y() < top.y()) top = p;
            middle += line.rowwise().sum();
            count += line.cols();
        }
        for (const Eigen::Matrix2Xd& line : lines) sheet.line(line, colour, width, from_above);
        if (lines.empty()) return;
        constexpr double kNameDistance = 13;
        const bool fits_above = top.y() - kNameDistance > layout.map_corner.y() + kLabelCapitals;
        const Vector2d inwards = (middle / double(count) - top).normalized();
        Vector2d at = top + kNameDistance * (fits_above ? Vector2d(0, -1) : inwards);
        const double left = layout.map_corner.x() + kLabelCapitals; // keeps the name within the frame
        at.x() = std::clamp(at.x(), left, left + layout.map_size.x() - 2 * kLabelCapitals);
        sheet.text(name, at, kLabelCapitals, colour, Align::centre, true);
    };
    for (const Outline& outline : outlines)
        draw(outline.line, outline.name == "S" ? kSamplingEdge : kInsideEdge, outline.name == "S" ? 1 : 2,
             outline.name);
}

} // namespace fettle::draw
