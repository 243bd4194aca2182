#include "report/figures.h"
#include "report/sections.h"

namespace fettle {

Html plan_section(const RunFiles& run)
{
    if (!run.plan) return {};
    const Plan& plan = *run.plan;
    const Units& units = run.units;
    double length = 0;
    for (const Pass& pass : plan.passes)
        for (const Interval& interval : pass.intervals) length += interval.second - interval.first;
    const auto mm = [&](const std::string& key, double value) { return length_figure("plan." + key, value, units); };
    const Html left = facts({{"Thickness of a layer", mm("layers.thickness", plan.layers.thickness)},
                             {"Distance of adjacent layers", mm("layers.distance", plan.layers.distance)},
                             {"Passes over B", count_text(double(plan.passes.size()))}});
    const Html right = facts({{"Length of the passes", length_figure("plan.covering_length", length, units)},
                              {"Time of one covering", duration_text(length / plan.job.feed.rate)},
                              {"A force reading every", mm("step", plan.step)}});
    return section("plan", "Plan", element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle
