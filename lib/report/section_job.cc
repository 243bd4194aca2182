#include "job/boundary.h"
#include "report/charts.h"
#include "report/figures.h"
#include "report/sections.h"

#include <cctype>
#include <numbers>

namespace fettle {

Html job_section(const RunFiles& run)
{
    if (!run.job) return {};
    const Job& job = *run.job;
    const Units& units = run.units;
    const std::string length_unit = to_string(units.length), force_unit = to_string(units.force);
    const auto length = [&](const std::string& key, double mm) { return length_figure("job." + key, mm, units); };
    const auto force = [&](const std::string& key, double newton) { return force_figure("job." + key, newton, units); };
    constexpr double kDegrees = 180 / std::numbers::pi;

    Html surface = job.surface == SurfaceType::freeform ? "free-form" : to_string(job.surface);
    if (job.surface == SurfaceType::swept)
        surface += ", rulings " + short_text(job.direction * kDegrees) + "\u00B0 from " + symbol("X_w");
    const double area_of_b = area(boundaries(job).anomaly) / (units.mm() * units.mm());
    const double stiffness = job.force.stiffness / to_base(units, {-1, 1});
    const double removal = job.removal / to_base(units, {3, -1});

    const Html left =
        facts({{"Surface", surface},
               {"Tolerance", "\u00B1" + length("tolerance", job.tolerance)},
               {"Area inside B", Html(short_text(area_of_b) + " " + length_unit + "\u00B2")},
               {"Probe, 99 % within", "\u00B1" + length("probe.accuracy", job.probe.accuracy)},
               {"Radius of the probe's tip", length("probe.tip_radius", job.probe.tip_radius)},
               {"Safe height", length("safe_height", job.safe_height)},
               {"Working frame", Html(short_text(job.theta * kDegrees) + "\u00B0 from " + symbol("X_m"))}});
    const Html right = facts(
        {{"Wheel",
          "radius " + length("wheel.radius", job.wheel.radius) + ", width " + length("wheel.width", job.wheel.width)},
         {"Worn out below", length("wheel.min_radius", job.wheel.min_radius)},
         {"Force: least, down, most",
          figure("job.force.min", job.force.min / units.newton(), short_text(job.force.min / units.newton())) + ", " +
              figure("job.force.down", job.force.down / units.newton(), short_text(job.force.down / units.newton())) +
              ", " + force("force.max", job.force.max)},
         {"Spring", figure("job.force.stiffness", stiffness, short_text(stiffness)) + " " + force_unit + "/" +
                        length_unit + ", preload " + force("force.preload", job.force.preload)},
         {"Feed", "along " + symbol(std::string(1, static_cast<char>(std::toupper(job.feed.axis))) + "_w") + ", " +
                      length("feed.rate", job.feed.rate) + "/s"},
         {"Step-over", length("feed.step_over", job.feed.step_over)},
         {"Removal", figure("job.removal.coefficient", removal, short_text(removal)) + " " + length_unit + "\u00B3/(" +
                         force_unit + " s)"}});
    const Sketch sketch = job_sketch(run);
    const Html drawing = drawing_with_caption(sketch.drawing, "Seen from above, to scale.");
    if (sketch.narrow)
        return section(
            "job", "Job",
            element("div", {{"class", "columns"}}, drawing + element("div", {{"class", "stacked"}}, left + right)));
    return section("job", "Job", drawing + element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle
