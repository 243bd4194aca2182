#include "draw/figures.h"
#include "report/sections.h"

namespace fettle::report {

draw::Html plan_section(const RunFiles& run)
{
    if (!run.plan) return {};
    const plan::Plan& plan = *run.plan;
    const units::Units& units = run.units;
    double length = 0;
    for (const plan::Pass& pass : plan.passes)
        for (const job::Interval& interval : pass.intervals) length += interval.second - interval.first;
    const auto mm = [&](const std::string& key, double value) { return length_figure("plan." + key, value, units); };
    const draw::Html left = property_table({{"Layer thickness", mm("layers.thickness", plan.layers.thickness)},
                                            {"Distance between layers", mm("layers.distance", plan.layers.distance)},
                                            {"Passes over B", draw::count_text(double(plan.passes.size()))}});
    const draw::Html right =
        property_table({{"Length of the passes", length_figure("plan.covering_length", length, units)},
                        {"Time of one covering", draw::duration_text(length / plan.job.feed.rate)},
                        {"Distance between force readings", mm("step", plan.step)}});
    return section("plan", "Plan", draw::element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle::report
