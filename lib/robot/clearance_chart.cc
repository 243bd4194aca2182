#include "robot/cell_picture.h"

#include "draw/canvas.h"
#include "draw/chart.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

// Points of a curve: more would fall on the same pixels.
constexpr std::size_t kMaxCurvePoints = 800;

// A curve over the poses with the minimum of each section of the path; NaN values are left out.
// @param value_of  (pose) -> its value
template <typename ValueOf>
draw::Curve min_curve(std::size_t poses, const std::string& name, const draw::Rgb& colour, const ValueOf& value_of)
{
    const std::size_t count = std::min(kMaxCurvePoints, poses);
    draw::Curve curve{name, Eigen::Matrix2Xd(2, count), colour, false};
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t first = k * poses / count, end = (k + 1) * poses / count;
        double min = NAN;
        for (std::size_t i = first; i < end; ++i) min = std::fmin(min, value_of(i));
        curve.points.col(k) << double(first), min;
    }
    return curve;
}

draw::Curve clearance_curve(const std::vector<CellClearance>& list, const std::string& name, const draw::Rgb& colour,
                            double mm)
{
    return min_curve(list.size(), name, colour, [&](std::size_t i) { return list[i].clearance / mm; });
}

// The largest tilt of each section.
draw::Chart tilt_chart(const std::vector<PoseChange>& changes)
{
    const auto negative_degrees = [&](std::size_t i) { return -(changes[i].tilt.norm() * 180 / std::numbers::pi); };
    draw::Curve curve = min_curve(changes.size(), "", draw::curve_colour(1), negative_degrees);
    curve.points.row(1) *= -1;
    return {"", "pose", "tilt, degrees", {curve}};
}

} // namespace

std::string draw_clearance_chart(const CheckedPath& checked, const CheckedPath* before,
                                 const std::vector<PoseChange>* changes, double tolerance, const units::Units& units)
{
    constexpr int kWidth = 1100, kHeight = 460, kTiltHeight = 280;
    constexpr draw::Rgb kFaint = {205, 205, 205}, kGrey = {150, 150, 150}, kRed = {200, 30, 40};
    draw::Chart chart;
    chart.title = "Clearance along the path";
    chart.x_label = "pose";
    chart.y_label = std::string("minimum clearance, ") + units::to_string(units.length) +
                    ", between poses a lower bound; below the red line it collides";
    if (before != nullptr) {
        chart.curves.push_back(clearance_curve(before->between_poses, "before, between", kFaint, units.mm()));
        chart.curves.push_back(clearance_curve(before->at_poses, "before, at poses", kGrey, units.mm()));
    }
    chart.curves.push_back(clearance_curve(checked.between_poses, "between poses", draw::curve_colour(5), units.mm()));
    chart.curves.push_back(clearance_curve(checked.at_poses, "at poses", draw::curve_colour(0), units.mm()));
    Eigen::Matrix2d limit; // drawn last, so that no curve along it hides it
    limit << 0, double(checked.at_poses.size()), -tolerance / units.mm(), -tolerance / units.mm();
    chart.curves.push_back({"", limit, kRed, false});
    draw::Canvas canvas(kWidth, kHeight + (changes == nullptr ? 0 : kTiltHeight));
    draw::draw_chart(canvas, {0, 0}, {kWidth, kHeight}, chart);
    if (changes != nullptr) draw::draw_chart(canvas, {0, kHeight}, {kWidth, kTiltHeight}, tilt_chart(*changes));
    return canvas.png();
}

} // namespace fettle::robot
