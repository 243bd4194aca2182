#include "compare/ticks.h"
#include "plan/wheel_section.h"
#include "report/charts.h"
#include "report/figures.h"
#include "report/svg.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using svg::Anchor;

constexpr double kMapHeight = 330, kMargin = 26, kBesideMap = 72, kLine = 22;

/// From the machine's x-y plane to the drawing.
struct Sheet {
    Vector2d least, corner; ///< lower left, of the part and of the drawing
    double scale = 1;       ///< pixels a mm

    Vector2d operator()(const Vector2d& xy) const
    {
        return corner + scale * Vector2d(xy.x() - least.x(), least.y() - xy.y());
    }
    Matrix2Xd all(const Eigen::Matrix3Xd& points) const
    {
        Matrix2Xd placed(2, points.cols());
        for (Index i = 0; i < points.cols(); ++i) placed.col(i) = (*this)(points.col(i).head<2>());
        return placed;
    }
};

/// The touches with their roles, and which were left out as slips.
struct Touches {
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd(3, 0);
    Eigen::VectorXd roles;
    std::vector<Index> slips;
};

Touches touches_of(const RunFiles& run)
{
    Touches touches;
    if (run.surface && run.surface->touches.cols() > 0) {
        touches.points = run.surface->touches;
        touches.roles = run.surface->roles.cast<double>();
        touches.slips = run.surface->gross_errors;
    } else if (run.samples) {
        touches.points = run.samples->xyz;
        touches.roles = has_field(*run.samples, "role") ? field(*run.samples, "role")
                                                        : Eigen::VectorXd::Constant(touches.points.cols(), 1);
    }
    return touches;
}

Html draw_touches(const Sheet& sheet, const Touches& touches)
{
    Html html;
    for (Index i = 0; i < touches.points.cols(); ++i) {
        if (!touches.points.col(i).head<2>().allFinite()) continue;
        const Vector2d at = sheet(touches.points.col(i).head<2>());
        const bool slip = std::find(touches.slips.begin(), touches.slips.end(), i) != touches.slips.end();
        if (slip)
            html += svg::circle(at, 7, "slip") +
                    svg::path("M" + svg::coordinate(at.x() - 4) + " " + svg::coordinate(at.y() - 4) + "l8 8m0 -8l-8 8",
                              "slip");
        else
            html += svg::circle(at, 3.2, touches.roles[i] == 0 ? "touch-edge" : "touch");
    }
    return html;
}

Html draw_passes(const Sheet& sheet, const Plan& plan)
{
    const Eigen::Matrix2d axes = pass_axes(plan.job);
    std::string path;
    const auto add = [&](char command, const Vector2d& across_along) {
        const Vector2d at = sheet(axes * across_along);
        path += command + svg::coordinate(at.x()) + " " + svg::coordinate(at.y());
    };
    for (const Pass& pass : plan.passes)
        for (const Interval& interval : pass.intervals) {
            add('M', {pass.line, interval.first});
            add('L', {pass.line, interval.second});
        }
    return svg::path(path, "pass");
}

/// X_w and Y_w, the axes that the job's directions refer to.
Html draw_working_axes(const Vector2d& at, double theta)
{
    constexpr double kLength = 26, kRoom = 15;
    Html html;
    const Eigen::Matrix2d rotation_machine_working = rotation_working_machine(theta).transpose();
    for (int axis = 0; axis < 2; ++axis) {
        const Vector2d way = rotation_machine_working.col(axis).cwiseProduct(Vector2d(1, -1));
        html += svg::line(at, at + kLength * way, "axis-w");
        html += svg::text(at + (kLength + kRoom) * way + Vector2d(0, 4), axis == 0 ? "X_w" : "Y_w", Anchor::middle);
    }
    return html + svg::circle(at, 2, "touch");
}

/// The key, as many lines as it takes; how high it is.
std::pair<Html, double> draw_key(double top, double width, const RunFiles& run, const Touches& touches)
{
    Html html;
    Vector2d at(kMargin, top);
    const auto add = [&](const std::string& words, const auto& sample) {
        constexpr double kLetter = 6.4, kSample = 24, kApart = 20;
        const double needed = kSample + kLetter * double(words.size());
        if (at.x() + needed > width && at.x() > kMargin) at = Vector2d(kMargin, at.y() + kLine);
        html += sample(at) + svg::text(at + Vector2d(kSample, 4), words);
        at.x() += needed + kApart;
    };
    const auto stroke = [](const char* style) {
        return [style](const Vector2d& p) { return svg::line(p, p + Vector2d(18, 0), style); };
    };
    const auto ring = [](double radius, const char* style) {
        return [radius, style](const Vector2d& p) { return svg::circle(p + Vector2d(9, 0), radius, style); };
    };
    add("B, anomaly", stroke("edge-b"));
    if (run.job->sampling.cols() > 0) add("S, may be touched", stroke("edge-s"));
    if (touches.points.cols() > 0) add("touch", ring(3.2, "touch"));
    if (!touches.slips.empty()) add("slip, left out", ring(6, "slip"));
    if (run.plan) {
        add("pass", stroke("pass"));
        add("start", ring(5, "start"));
    }
    return {html, at.y() - top + kLine};
}

} // namespace

Sketch job_sketch(const RunFiles& run)
{
    const Job& job = *run.job;
    const Touches touches = touches_of(run);
    Eigen::AlignedBox2d box;
    for (const Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling, &touches.points})
        for (const Eigen::Vector3d& p : points->colwise())
            if (p.head<2>().allFinite()) box.extend(p.head<2>());
    const Vector2d size = box.sizes();
    constexpr double kWide = 1.6, kWholePage = 720, kHalfPage = 345; // drawn as large as it is shown: so are letters
    Sketch sketch;
    sketch.narrow = size.x() < kWide * size.y();
    const double width = sketch.narrow ? kHalfPage : kWholePage;
    Sheet sheet;
    sheet.least = box.min();
    sheet.scale = std::min((width - kMargin - kBesideMap) / size.x(), kMapHeight / size.y());
    const double height = sheet.scale * size.y();
    sheet.corner = {kMargin, kMargin + height};

    Html html;
    if (job.sampling.cols() > 0) html += svg::polygon(sheet.all(job.sampling), "edge-s");
    if (run.plan) html += draw_passes(sheet, *run.plan);
    html += svg::polygon(sheet.all(job.anomaly), "edge-b");
    if (run.plan) html += svg::circle(sheet(run.plan->start.head<2>()), 5, "start");
    html += draw_touches(sheet, touches);

    const double mm = run.units.mm(), bottom = kMargin + height + 26;
    const double length = tick_step(size.maxCoeff() / mm, 6);
    html += svg::box({kMargin, bottom}, {length * mm * sheet.scale, 4}, "scale-bar");
    html += svg::text({kMargin + length * mm * sheet.scale + 8, bottom + 7},
                      short_text(length) + " " + to_string(run.units.length));
    const auto [key, key_height] = draw_key(bottom + 26, width, run, touches);
    html += key;
    html += draw_working_axes({kMargin + sheet.scale * size.x() + (sketch.narrow ? 14 : 44), bottom - 2}, job.theta);
    sketch.drawing =
        svg::drawing(width, bottom + 26 + key_height - 8, "boundaries, touches and passes from above", html);
    return sketch;
}

} // namespace fettle
