#include "draw/figures.h"
#include "draw/svg.h"
#include "draw/ticks.h"
#include "plan/wheel_section.h"
#include "report/charts.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace fettle::report {
namespace {

using draw::svg::Anchor;
using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::Vector2d;

constexpr double kMapHeight = 330, kMargin = 26, kBesideMap = 72, kLineHeight = 22;

/// Transform from the machine's x-y plane to the drawing.
struct Sheet {
    Vector2d min, corner; ///< lower left corner of the part, mm, and of its drawing, pixels
    double scale = 1;     ///< pixels per mm

    Vector2d operator()(const Vector2d& xy) const
    {
        return corner + scale * Vector2d(xy.x() - min.x(), min.y() - xy.y());
    }
    Matrix2Xd all(const Eigen::Matrix3Xd& points) const
    {
        Matrix2Xd placed(2, points.cols());
        for (Index i = 0; i < points.cols(); ++i) placed.col(i) = (*this)(points.col(i).head<2>());
        return placed;
    }
};

/// The touches with their roles, and the indices of the outliers.
struct Touches {
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd(3, 0);
    Eigen::VectorXd roles;
    std::vector<Index> outliers;
};

Touches touches_of(const RunFiles& run)
{
    Touches touches;
    if (run.surface && run.surface->touches.cols() > 0) {
        touches.points = run.surface->touches;
        touches.roles = run.surface->roles.cast<double>();
        touches.outliers = run.surface->outliers;
    } else if (run.samples) {
        touches.points = run.samples->xyz;
        touches.roles = cloud::has_field(*run.samples, "role") ? cloud::field(*run.samples, "role")
                                                               : Eigen::VectorXd::Constant(touches.points.cols(), 1);
    }
    return touches;
}

draw::Html draw_touches(const Sheet& sheet, const Touches& touches)
{
    draw::Html html;
    for (Index i = 0; i < touches.points.cols(); ++i) {
        if (!touches.points.col(i).head<2>().allFinite()) continue;
        const Vector2d at = sheet(touches.points.col(i).head<2>());
        if (std::ranges::find(touches.outliers, i) != touches.outliers.end())
            html += draw::svg::circle(at, 7, "outlier") +
                    draw::svg::path("M" + draw::svg::coordinate(at.x() - 4) + " " + draw::svg::coordinate(at.y() - 4) +
                                        "l8 8m0 -8l-8 8",
                                    "outlier");
        else
            html += draw::svg::circle(at, 3.2, touches.roles[i] == 0 ? "touch-edge" : "touch");
    }
    return html;
}

draw::Html draw_passes(const Sheet& sheet, const plan::Plan& plan)
{
    const Eigen::Matrix2d axes = plan::pass_axes(plan.job);
    std::string path;
    const auto add = [&](char command, const Vector2d& across_along) {
        const Vector2d at = sheet(axes * across_along);
        path += command + draw::svg::coordinate(at.x()) + " " + draw::svg::coordinate(at.y());
    };
    for (const plan::Pass& pass : plan.passes)
        for (const job::Interval& interval : pass.intervals) {
            add('M', {pass.line, interval.first});
            add('L', {pass.line, interval.second});
        }
    return draw::svg::path(path, "pass");
}

/// The axes X_w and Y_w, to which the job's directions refer.
draw::Html draw_working_axes(const Vector2d& at, double theta)
{
    constexpr double kLength = 26, kTextGap = 15;
    draw::Html html;
    const Eigen::Matrix2d rotation_machine_working = job::rotation_working_machine(theta).transpose();
    for (int axis = 0; axis < 2; ++axis) {
        const Vector2d direction = rotation_machine_working.col(axis).cwiseProduct(Vector2d(1, -1));
        html += draw::svg::line(at, at + kLength * direction, "axis-w");
        html += draw::svg::text(at + (kLength + kTextGap) * direction + Vector2d(0, 4), axis == 0 ? "X_w" : "Y_w",
                                Anchor::middle);
    }
    return html + draw::svg::circle(at, 2, "touch");
}

/// The key, in as many lines as needed, and its height.
std::pair<draw::Html, double> draw_key(double top, double width, const RunFiles& run, const Touches& touches)
{
    draw::Html html;
    Vector2d at(kMargin, top);
    const auto add = [&](const std::string& words, const auto& sample) {
        constexpr double kLetterWidth = 6.4, kSampleWidth = 24, kGap = 20;
        const double needed = kSampleWidth + kLetterWidth * double(words.size());
        if (at.x() + needed > width && at.x() > kMargin) at = Vector2d(kMargin, at.y() + kLineHeight);
        html += sample(at) + draw::svg::text(at + Vector2d(kSampleWidth, 4), words);
        at.x() += needed + kGap;
    };
    const auto stroke = [](const char* style) {
        return [style](const Vector2d& p) { return draw::svg::line(p, p + Vector2d(18, 0), style); };
    };
    const auto ring = [](double radius, const char* style) {
        return [radius, style](const Vector2d& p) { return draw::svg::circle(p + Vector2d(9, 0), radius, style); };
    };
    add("B, anomaly", stroke("edge-b"));
    if (run.job->sampling.cols() > 0) add("S, sampling boundary", stroke("edge-s"));
    if (touches.points.cols() > 0) add("touch", ring(3.2, "touch"));
    if (!touches.outliers.empty()) add("outlier, left out", ring(6, "outlier"));
    if (run.plan) {
        add("pass", stroke("pass"));
        add("start", ring(5, "start"));
    }
    return {html, at.y() - top + kLineHeight};
}

} // namespace

Sketch job_sketch(const RunFiles& run)
{
    const job::Job& job = *run.job;
    const Touches touches = touches_of(run);
    Eigen::AlignedBox2d box;
    for (const Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling, &touches.points})
        for (const Eigen::Vector3d& p : points->colwise())
            if (p.head<2>().allFinite()) box.extend(p.head<2>());
    const Vector2d size = box.sizes();
    constexpr double kMinHeightToWidth = 1.6, kWholePage = 720, kHalfPage = 345; // pixels; drawn at its displayed size
    Sketch sketch;
    sketch.narrow = size.x() < kMinHeightToWidth * size.y();
    const double width = sketch.narrow ? kHalfPage : kWholePage;
    Sheet sheet;
    sheet.min = box.min();
    sheet.scale = std::min((width - kMargin - kBesideMap) / size.x(), kMapHeight / size.y());
    const double height = sheet.scale * size.y();
    sheet.corner = {kMargin, kMargin + height};

    draw::Html html;
    if (job.sampling.cols() > 0) html += draw::svg::polygon(sheet.all(job.sampling), "edge-s");
    if (run.plan) html += draw_passes(sheet, *run.plan);
    html += draw::svg::polygon(sheet.all(job.anomaly), "edge-b");
    if (run.plan) html += draw::svg::circle(sheet(run.plan->start.head<2>()), 5, "start");
    html += draw_touches(sheet, touches);

    const double mm = run.units.mm(), bottom = kMargin + height + 26;
    const double length = draw::tick_step(size.maxCoeff() / mm, 6);
    html += draw::svg::box({kMargin, bottom}, {length * mm * sheet.scale, 4}, "scale-bar");
    html += draw::svg::text({kMargin + length * mm * sheet.scale + 8, bottom + 7},
                            draw::short_text(length) + " " + units::to_string(run.units.length));
    const auto [key, key_height] = draw_key(bottom + 26, width, run, touches);
    html += key;
    html += draw_working_axes({kMargin + sheet.scale * size.x() + (sketch.narrow ? 14 : 44), bottom - 2}, job.theta);
    sketch.drawing =
        draw::svg::drawing(width, bottom + 26 + key_height - 8, "boundaries, touches and passes from above", html);
    return sketch;
}

} // namespace fettle::report
