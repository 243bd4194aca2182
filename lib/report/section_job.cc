#include "draw/figures.h"
#include "job/boundary.h"
#include "report/charts.h"
#include "report/sections.h"

#include <cctype>
#include <numbers>

namespace fettle::report {
namespace {

std::string plan_view_caption(const RunFiles& run)
{
    const auto touches = run.surface ? run.surface->touches.cols() : run.samples ? run.samples->xyz.cols() : 0;
    std::string caption = "Plan view, to scale";
    if (touches > 0) caption += ": " + draw::count_text(double(touches)) + " touches around the anomaly";
    if (run.plan)
        caption += (touches > 0 ? ", " : ": ") + draw::count_text(double(run.plan->passes.size())) + " passes over it";
    return caption + ".";
}

} // namespace

draw::Html job_section(const RunFiles& run)
{
    if (!run.job) return {};
    const job::Job& job = *run.job;
    const units::Units& units = run.units;
    const std::string length_unit = units::to_string(units.length), force_unit = units::to_string(units.force);
    const auto length = [&](const std::string& key, double mm) { return length_figure("job." + key, mm, units); };
    const auto force = [&](const std::string& key, double newton) { return force_figure("job." + key, newton, units); };
    constexpr double kDegrees = 180 / std::numbers::pi;

    draw::Html surface = job.surface == job::SurfaceType::freeform ? "free-form" : job::to_string(job.surface);
    if (job.surface == job::SurfaceType::swept)
        surface += ", rulings " + draw::short_text(job.ruling_direction * kDegrees) + "\u00B0 from " +
                   draw::symbol_with_subscript("X_w");
    const double area_of_b = job::area(job::working_boundaries(job).anomaly) / (units.mm() * units.mm());
    const double stiffness = job.force.stiffness / units::base_unit_factor(units, {-1, 1});
    const double removal = job.removal_coefficient / units::base_unit_factor(units, {3, -1});

    const draw::Html left =
        property_table({{"Surface", surface},
                        {"Tolerance", "\u00B1" + length("tolerance", job.tolerance)},
                        {"Area inside B", draw::Html(draw::short_text(area_of_b) + " " + length_unit + "\u00B2")},
                        {"Probe, 99 % within", "\u00B1" + length("probe.accuracy", job.probe.accuracy)},
                        {"Radius of the probe tip", length("probe.tip_radius", job.probe.tip_radius)},
                        {"Safe height", length("safe_height", job.safe_height)},
                        {"Working frame", draw::Html(draw::short_text(job.theta * kDegrees) + "\u00B0 from " +
                                                     draw::symbol_with_subscript("X_m"))}});
    const draw::Html right = property_table(
        {{"Wheel",
          "radius " + length("wheel.radius", job.wheel.radius) + ", width " + length("wheel.width", job.wheel.width)},
         {"Worn out below", length("wheel.min_radius", job.wheel.min_radius)},
         {"Force: min, down, max", number_figure("job.force.min", job.force.min / units.newton()) + ", " +
                                       number_figure("job.force.down", job.force.down / units.newton()) + ", " +
                                       force("force.max", job.force.max)},
         {"Spring", number_figure("job.force.stiffness", stiffness) + " " + force_unit + "/" + length_unit +
                        ", preload " + force("force.preload", job.force.preload)},
         {"Feed",
          "along " +
              draw::symbol_with_subscript(std::string(1, static_cast<char>(std::toupper(job.feed.axis))) + "_w") +
              ", " + length("feed.rate", job.feed.rate) + "/s"},
         {"Step-over", length("feed.step_over", job.feed.step_over)},
         {"Removal coefficient",
          number_figure("job.removal.coefficient", removal) + " " + length_unit + "\u00B3/(" + force_unit + " s)"}});
    const Sketch sketch = job_sketch(run);
    const draw::Html drawing = drawing_with_caption(sketch.drawing, plan_view_caption(run));
    if (sketch.narrow)
        return section("job", "Job",
                       draw::element("div", {{"class", "columns"}},
                                     drawing + draw::element("div", {{"class", "stacked"}}, left + right)));
    return section("job", "Job", drawing + draw::element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle::report
