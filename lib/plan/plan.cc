#include "plan/plan.h"

#include "core/error.h"
#include "core/text.h"
#include "job/safe_height.h"
#include "plan/wheel_fit.h"
#include "json/units.h"

#include <algorithm>
#include <cmath>

namespace fettle::plan {

namespace {

// Relative tolerance of the agreement of a file's job, layers and passes: rounding of the written digits.
constexpr double kFileRounding = 1e-9;

// The anomaly B in the pass frame; its orientation depends on the axis, which has no effect on staircase().
job::Polygon anomaly_region(const job::Job& job)
{
    return pass_axes(job).transpose() * job::rotation_working_machine(job.theta).transpose() *
           job::working_boundaries(job).anomaly;
}

Eigen::Vector3d initial_point(const job::Polygon& region, const surface::Surface& surface, const Eigen::Matrix2d& axes)
{
    Eigen::Vector2d first = region.col(0); // smallest across, then along
    for (Eigen::Index i = 1; i < region.cols(); ++i)
        if (region(0, i) < first.x() || (region(0, i) == first.x() && region(1, i) < first.y())) first = region.col(i);
    Eigen::Vector3d point;
    point << axes * first, surface::height(surface, axes * first);
    return point;
}

/// The job with a safe height: where its file gives none, the surface is the first that is known of the part's height.
job::Job with_safe_height(job::Job job, const surface::Surface& surface, const job::Polygon& region)
{
    if (job.is_safe_height_known) return job;
    double highest = surface::heights(surface, pass_axes(job) * region).maxCoeff();
    for (const Eigen::Vector3d& touch : surface.touches.colwise()) highest = std::fmax(highest, touch.z());
    job::set_safe_height_over(job, highest);
    return job;
}

int highest_layer(const job::Job& job, const surface::Surface& surface, const job::Polygon& region,
                  const Layers& layers)
{
    const Eigen::Matrix2Xd corners = pass_axes(job) * region;
    const Eigen::VectorXd z = surface::heights(surface, corners);
    Eigen::Index top = 0;
    const double highest = z.maxCoeff(&top);
    if (highest >= job.safe_height)
        throw core::InputError(job.source, "safe_height: " + core::to_short_text(job.safe_height / job.units.mm()) +
                                               " is not above the surface, " +
                                               core::to_short_text(highest / job.units.mm()) + " at " +
                                               job::point_text(corners.col(top), job.units));
    constexpr double kMaxLayers = 1e6; // reached if the spring is so stiff that layers have almost no thickness
    const double distances = (job.safe_height - z.minCoeff()) / layers.distance * (1 + kFileRounding);
    return 1 + int(std::min(kMaxLayers, std::floor(distances)));
}

json::Value passes_to_json(const Plan& plan)
{
    const Eigen::Matrix2d axes = pass_axes(plan.job);
    const double mm = plan.job.units.mm();
    std::vector<json::Value> values;
    for (std::size_t p = 0; p < plan.passes.size(); ++p)
        for (const job::Interval& interval : plan.passes[p].intervals) {
            const Eigen::VectorXd from = axes * Eigen::Vector2d(plan.passes[p].line, interval.first) / mm;
            const Eigen::VectorXd to = axes * Eigen::Vector2d(plan.passes[p].line, interval.second) / mm;
            values.push_back(json::Value().set("pass", p + 1).set("from", from).set("to", to));
        }
    return values;
}

std::vector<Pass> passes_from_json(json::Reader& reader, const job::Job& job)
{
    const Eigen::Matrix2d axes = pass_axes(job);
    std::vector<Pass> passes;
    for (json::Reader& entry : reader.objects("passes")) {
        const int number = entry.integer("pass", 1, kMaxPasses);
        const Eigen::Vector2d from = axes.transpose() * entry.vector("from", 2) * job.units.mm();
        const Eigen::Vector2d to = axes.transpose() * entry.vector("to", 2) * job.units.mm();
        entry.reject_unknown_keys();
        const double rounding = kFileRounding * (1 + from.norm() + to.norm());
        if (std::abs(from.x() - to.x()) > rounding)
            entry.refuse("to", "the pass does not run along the job's feed axis");
        if (to.y() <= from.y()) entry.refuse("to", "the pass ends before it begins");
        if (number == int(passes.size()) + 1) {
            if (!passes.empty() && from.x() <= passes.back().line)
                entry.refuse("pass", "does not lie beyond the one before it");
            passes.push_back({from.x(), {}});
        } else if (number != int(passes.size()) || std::abs(from.x() - passes.back().line) > rounding ||
                   from.y() <= passes.back().intervals.back().second) {
            entry.refuse("pass", "the passes are not in order");
        }
        passes.back().intervals.emplace_back(from.y(), to.y());
    }
    if (passes.empty()) reader.refuse("passes", "there are none");
    return passes;
}

void check_layers(json::Reader reader, const Plan& plan)
{
    const double mm = plan.job.units.mm();
    const auto check = [&](const char* key, double expected) {
        const double value = reader.number(key) * mm;
        if (std::abs(value - expected) > kFileRounding * expected)
            reader.refuse(key, core::to_short_text(value / mm) + " does not follow from the job's forces, which give " +
                                   core::to_short_text(expected / mm));
    };
    check("thickness", plan.layers.thickness);
    check("distance", plan.layers.distance);
    if (reader.integer("overlap_case", 1, 3) != plan.layers.overlap_case)
        reader.refuse("overlap_case", "does not follow from the job's forces");
    reader.reject_unknown_keys();
}

constexpr int kMaxCount = 1000000000;

StrategyLimits read_bounds(json::Reader reader)
{
    StrategyLimits bounds;
    bounds.layers = reader.integer("layers", 1, kMaxCount);
    bounds.re_cuts = reader.integer("re_cuts", 0, kMaxCount);
    bounds.coverings = reader.integer("coverings", 1, kMaxCount);
    bounds.time = reader.number("time", core::Range::positive());
    bounds.steps = reader.integer("steps", 1, kMaxCount);
    reader.reject_unknown_keys();
    return bounds;
}

} // namespace

Plan make_plan(const job::Job& job, const surface::Surface& surface)
{
    check_wheel_fits(job, surface);
    const Eigen::Matrix2d axes = pass_axes(job);
    const job::Polygon region = anomaly_region(job);
    Plan plan;
    plan.job = with_safe_height(job, surface, region);
    plan.surface = surface;
    plan.layers = compute_layers(job.force);
    plan.start = initial_point(region, surface, axes);
    plan.bounds.layers = highest_layer(plan.job, surface, region, plan.layers);
    try {
        plan.passes =
            staircase(region, [&](const Eigen::Matrix2Xd& points) { return surface::heights(surface, axes * points); },
                      wheel_sections(job.wheel.radius, job.wheel.width, job.feed.axis),
                      {job.feed.step_over, kScallopPerTolerance * job.tolerance});
    } catch (const core::InputError& error) {
        throw core::InputError(job.source, error.what());
    }
    return plan;
}

Plan read_plan(const std::string& path) { return parse_plan(json::Reader::open(path)); }

JobOrPlan read_job_or_plan(const std::string& path)
{
    json::Reader reader = json::Reader::open(path);
    if (reader.choice("kind", {"job", "plan"}) == "job") return {job::parse_job(reader), false};
    return {parse_plan(reader).job, true};
}

Plan parse_plan(json::Reader reader)
{
    reader.expect_kind("plan");
    Plan plan;
    json::Reader units = reader.object("units");
    const std::string length = units.choice("length", {"mm", "in"});
    const std::string force = units.choice("force", {"N", "lbf"});
    units.reject_unknown_keys();
    plan.job = job::parse_job(reader.object("job"));
    plan.surface = surface::parse_surface(reader.object("surface"));
    if (units::parse_length_unit(length) != plan.job.units.length ||
        units::parse_force_unit(force) != plan.job.units.force)
        reader.refuse("units", length + ", " + force + " are not the units of the job");
    const double mm = plan.job.units.mm();
    plan.layers = compute_layers(plan.job.force);
    check_layers(reader.object("layers"), plan);
    plan.start = reader.vector("start", 3) * mm;
    plan.passes = passes_from_json(reader, plan.job);
    plan.step = reader.number("step", core::Range::positive()) * mm;
    plan.bounds = read_bounds(reader.object("bounds"));
    reader.reject_unknown_keys();
    return plan;
}

json::Value to_json(const Plan& plan)
{
    const double mm = plan.job.units.mm();
    json::Value value;
    return value.set("kind", "plan")
        .set("units", json::to_json(plan.job.units))
        .set("layers", json::Value()
                           .set("thickness", plan.layers.thickness / mm)
                           .set("distance", plan.layers.distance / mm)
                           .set("overlap_case", plan.layers.overlap_case))
        .set("start", json::Value(Eigen::VectorXd(plan.start / mm)))
        .set("step", plan.step / mm)
        .set("bounds", json::Value()
                           .set("layers", plan.bounds.layers)
                           .set("re_cuts", plan.bounds.re_cuts)
                           .set("coverings", plan.bounds.coverings)
                           .set("time", plan.bounds.time)
                           .set("steps", plan.bounds.steps))
        .set("passes", passes_to_json(plan))
        .set("job", job::to_json(plan.job))
        .set("surface", surface::to_json(plan.surface));
}

json::Value report_json(const Plan& plan)
{
    const double mm = plan.job.units.mm();
    double length = 0, max_step_over = 0;
    for (std::size_t p = 0; p < plan.passes.size(); ++p) {
        for (const job::Interval& interval : plan.passes[p].intervals) length += interval.second - interval.first;
        if (p > 0) max_step_over = std::max(max_step_over, plan.passes[p].line - plan.passes[p - 1].line);
    }
    json::Value report;
    return report.set("layer_thickness", plan.layers.thickness / mm)
        .set("layer_distance", plan.layers.distance / mm)
        .set("overlap_case", plan.layers.overlap_case)
        .set("max_layers", plan.bounds.layers)
        .set("passes", plan.passes.size())
        .set("widest_step_over", max_step_over / mm)
        .set("covering_length", length / mm)
        .set("covering_time", length / plan.job.feed.rate);
}

} // namespace fettle::plan
