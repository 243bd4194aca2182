#include "robot/cell_picture.h"

#include "compare/canvas.h"
#include "compare/chart.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle {

namespace {

// The least of so many stretches of the path is drawn: more would fall on the same pixels.
constexpr std::size_t kStretches = 800;

Curve curve_of(const std::vector<CellClearance>& list, const std::string& name, const Rgb& colour, double mm)
{
    const std::size_t count = std::min(kStretches, list.size());
    Curve curve{name, Eigen::Matrix2Xd(2, static_cast<Eigen::Index>(count)), colour, false};
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t first = k * list.size() / count, end = (k + 1) * list.size() / count;
        double least = NAN;
        for (std::size_t i = first; i < end; ++i) least = std::fmin(least, list[i].clearance);
        curve.points.col(static_cast<Eigen::Index>(k)) << double(first), least / mm;
    }
    return curve;
}

// The largest tilt of each stretch, degrees.
Chart tilt_chart(const std::vector<PoseChange>& changes)
{
    const std::size_t count = std::min(kStretches, changes.size());
    Curve curve{"", Eigen::Matrix2Xd(2, static_cast<Eigen::Index>(count)), curve_colour(1), false};
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t first = k * changes.size() / count, end = (k + 1) * changes.size() / count;
        double most = 0;
        for (std::size_t i = first; i < end; ++i) most = std::max(most, changes[i].tilt.norm());
        curve.points.col(static_cast<Eigen::Index>(k)) << double(first), most * 180 / std::numbers::pi;
    }
    return {"", "pose", "tilt, degrees", {curve}};
}

} // namespace

std::string clearance_chart(const CheckedPath& checked, const CheckedPath* before,
                            const std::vector<PoseChange>* changes, const Units& units)
{
    constexpr int kWidth = 1100, kHeight = 460, kTilts = 280;
    constexpr Rgb kFaint = {205, 205, 205}, kGrey = {150, 150, 150}, kRed = {200, 30, 40};
    Chart chart;
    chart.title = "Clearance along the path";
    chart.x_label = "pose";
    chart.y_label = std::string("least clearance, ") + to_string(units.length) + "; below the red line it collides";
    if (before != nullptr) {
        chart.curves.push_back(curve_of(before->between, "before, between", kFaint, units.mm()));
        chart.curves.push_back(curve_of(before->pose, "before, at poses", kGrey, units.mm()));
    }
    chart.curves.push_back(curve_of(checked.between, "between poses", curve_colour(5), units.mm()));
    chart.curves.push_back(curve_of(checked.pose, "at poses", curve_colour(0), units.mm()));
    Eigen::Matrix2d zero; // last: a curve that runs along it does not hide it
    zero << 0, static_cast<double>(checked.pose.size()), 0, 0;
    chart.curves.push_back({"", zero, kRed, false});
    Canvas canvas(kWidth, kHeight + (changes == nullptr ? 0 : kTilts));
    draw_chart(canvas, {0, 0}, {kWidth, kHeight}, chart);
    if (changes != nullptr) draw_chart(canvas, {0, kHeight}, {kWidth, kTilts}, tilt_chart(*changes));
    return canvas.png();
}

} // namespace fettle
