#include "plan/plan.h"

#include "core/error.h"
#include "core/text.h"
#include "plan/wheel_fit.h"
#include "json/units.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// Job and passes of a file agree within the digits that are written, relative to the size of the coordinates.
constexpr double kWrittenDigits = 1e-9;

HeightsAcross heights_across(const Surface& surface, const Eigen::Matrix2d& axes)
{
    return [&surface, axes](const Eigen::Matrix2Xd& places) { return heights(surface, axes * places); };
}

// B in the pass frame, counter-clockwise or not: staircase() does not mind.
Polygon region_of(const Job& job)
{
    return pass_axes(job).transpose() * rotation_working_machine(job.theta).transpose() * boundaries(job).anomaly;
}

Eigen::Vector3d initial_point(const Polygon& region, const Surface& surface, const Eigen::Matrix2d& axes)
{
    Eigen::Vector2d least = region.col(0);
    for (Eigen::Index i = 1; i < region.cols(); ++i)
        if (region(0, i) < least.x() || (region(0, i) == least.x() && region(1, i) < least.y())) least = region.col(i);
    Eigen::Vector3d point;
    point << axes * least, height(surface, axes * least);
    return point;
}

int highest_layer(const Job& job, const Surface& surface, const Polygon& region, const Layers& layers)
{
    const Eigen::Matrix2Xd corners = pass_axes(job) * region;
    const Eigen::VectorXd z = heights(surface, corners);
    Eigen::Index top = 0;
    const double highest = z.maxCoeff(&top);
    if (highest >= job.safe_height)
        throw InputError(job.source, "safe_height: " + to_short_text(job.safe_height / job.units.mm()) +
                                         " is not above the surface, " + to_short_text(highest / job.units.mm()) +
                                         " at " + place(corners.col(top), job.units));
    constexpr double kMostLayers = 1e6; // a spring so stiff that the layers have no thickness
    const double distances = (job.safe_height - z.minCoeff()) / layers.distance * (1 + kWrittenDigits);
    return 1 + int(std::min(kMostLayers, std::floor(distances)));
}

json::Value passes_to_json(const Plan& plan)
{
    const Eigen::Matrix2d axes = pass_axes(plan.job);
    const double mm = plan.job.units.mm();
    std::vector<json::Value> values;
    for (std::size_t p = 0; p < plan.passes.size(); ++p)
        for (const Interval& interval : plan.passes[p].intervals) {
            const Eigen::VectorXd from = axes * Eigen::Vector2d(plan.passes[p].line, interval.first) / mm;
            const Eigen::VectorXd to = axes * Eigen::Vector2d(plan.passes[p].line, interval.second) / mm;
            values.push_back(json::Value().set("pass", p + 1).set("from", from).set("to", to));
        }
    return values;
}

std::vector<Pass> passes_from_json(json::Reader& reader, const Job& job)
{
    const Eigen::Matrix2d axes = pass_axes(job);
    std::vector<Pass> passes;
    for (json::Reader& entry : reader.objects("passes")) {
        const int number = entry.integer("pass", 1, kMostPasses);
        const Eigen::Vector2d from = axes.transpose() * entry.vector("from", 2) * job.units.mm();
        const Eigen::Vector2d to = axes.transpose() * entry.vector("to", 2) * job.units.mm();
        entry.done();
        const double slack = kWrittenDigits * (1 + from.norm() + to.norm());
        if (std::abs(from.x() - to.x()) > slack) entry.refuse("to", "the pass does not run along the job's feed axis");
        if (to.y() <= from.y()) entry.refuse("to", "the pass ends before it begins");
        if (number == int(passes.size()) + 1) {
            if (!passes.empty() && from.x() <= passes.back().line)
                entry.refuse("pass", "does not lie beyond the one before it");
            passes.push_back({from.x(), {}});
        } else if (number != int(passes.size()) || std::abs(from.x() - passes.back().line) > slack ||
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
        if (std::abs(value - expected) > kWrittenDigits * expected)
            reader.refuse(key, to_short_text(value / mm) + " does not follow from the job's forces, which give " +
                                   to_short_text(expected / mm));
    };
    check("thickness", plan.layers.thickness);
    check("distance", plan.layers.distance);
    if (reader.integer("overlap_case", 1, 3) != plan.layers.overlap_case)
        reader.refuse("overlap_case", "does not follow from the job's forces");
    reader.done();
}

constexpr int kMostOfAnything = 1000000000;

Bounds read_bounds(json::Reader reader)
{
    Bounds bounds;
    bounds.layers = reader.integer("layers", 1, kMostOfAnything);
    bounds.re_cuts = reader.integer("re_cuts", 0, kMostOfAnything);
    bounds.coverings = reader.integer("coverings", 1, kMostOfAnything);
    bounds.time = reader.number("time", Range::positive());
    bounds.steps = reader.integer("steps", 1, kMostOfAnything);
    reader.done();
    return bounds;
}

} // namespace

Plan make_plan(const Job& job, const Surface& surface)
{
    check_wheel_fits(job, surface);
    const Eigen::Matrix2d axes = pass_axes(job);
    const Polygon region = region_of(job);
    Plan plan;
    plan.job = job;
    plan.surface = surface;
    plan.layers = layers_of(job.force);
    plan.start = initial_point(region, surface, axes);
    plan.bounds.layers = highest_layer(job, surface, region, plan.layers);
    try {
        plan.passes = staircase(region, heights_across(surface, axes),
                                wheel_sections(job.wheel.radius, job.wheel.width, job.feed.axis),
                                {.step_over = job.feed.step_over, .leftover = kLeftoverPerTolerance * job.tolerance});
    } catch (const InputError& error) {
        throw InputError(job.source, error.what());
    }
    return plan;
}

Plan read_plan(const std::string& path) { return parse_plan(json::Reader::open(path)); }

Work read_work(const std::string& path)
{
    json::Reader reader = json::Reader::open(path);
    if (reader.choice("kind", {"job", "plan"}) == "job") return {parse_job(reader), false};
    return {parse_plan(reader).job, true};
}

Plan parse_plan(json::Reader reader)
{
    reader.expect_kind("plan");
    Plan plan;
    json::Reader units = reader.object("units");
    const std::string length = units.choice("length", {"mm", "in"});
    const std::string force = units.choice("force", {"N", "lbf"});
    units.done();
    plan.job = parse_job(reader.object("job"));
    plan.surface = parse_surface(reader.object("surface"));
    if (parse_length_unit(length) != plan.job.units.length || parse_force_unit(force) != plan.job.units.force)
        reader.refuse("units", length + ", " + force + " are not the units of the job");
    const double mm = plan.job.units.mm();
    plan.layers = layers_of(plan.job.force);
    check_layers(reader.object("layers"), plan);
    plan.start = reader.vector("start", 3) * mm;
    plan.passes = passes_from_json(reader, plan.job);
    plan.step = reader.number("step", Range::positive()) * mm;
    plan.bounds = read_bounds(reader.object("bounds"));
    reader.done();
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
        .set("job", to_json(plan.job))
        .set("surface", to_json(plan.surface));
}

} // namespace fettle
