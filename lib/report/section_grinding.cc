#include "plan/layers.h"
#include "report/charts.h"
#include "report/figures.h"
#include "report/sections.h"
#include "strategy/layer_switching.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fettle {
namespace {

using Eigen::Index;

/// What a trace says about one layer.
struct LayerWork {
    double time = 0;    ///< s
    double ground = 0;  ///< with the feed on, s
    double impulse = 0; ///< ∫ force dt while grinding, N s
    double peak = 0;    ///< N
    int raised = 0, lowered = 0, re_cuts = 0;
};

std::map<int, LayerWork> layer_work(const Cloud& trace)
{
    const Eigen::VectorXd t = field(trace, "t"), force = field(trace, "force"), feed = field(trace, "feed");
    const Eigen::VectorXd layer = field(trace, "layer"), event = field(trace, "event");
    std::map<int, LayerWork> layers;
    for (Index i = 0; i < t.size(); ++i) {
        LayerWork& work = layers[static_cast<int>(layer[i])];
        const double took = i == 0 ? t[i] : t[i] - t[i - 1];
        work.time += took;
        if (std::isfinite(force[i])) work.peak = std::max(work.peak, force[i]);
        if (feed[i] > 0) {
            work.ground += took;
            work.impulse += took * force[i];
        }
        work.raised += event[i] == static_cast<int>(Event::up);
        work.lowered += event[i] == static_cast<int>(Event::down);
        work.re_cuts += event[i] == static_cast<int>(Event::re_cut);
    }
    return layers;
}

Html layer_table(const RunFiles& run)
{
    const Units& units = run.units;
    const std::string force = ", " + to_string(units.force);
    std::vector<Html> names = {"Layer", "Time", "Grinding", "Mean force" + force, "Peak force" + force};
    if (run.job) names.insert(names.end(), {"Peak of " + symbol("F_max"), "Height, " + to_string(units.length)});
    for (const char* name : {"Raised to", "Lowered to", "Re-cuts"}) names.emplace_back(name);
    std::vector<std::vector<Html>> rows;
    for (const auto& [number, work] : layer_work(*run.trace)) {
        const std::string key = "trace.layers." + std::to_string(number) + ".";
        const double peak = work.peak / units.newton();
        std::vector<Html> row = {std::to_string(number), figure(key + "time", work.time, duration_text(work.time)),
                                 duration_text(work.ground),
                                 work.ground > 0 ? short_text(work.impulse / work.ground / units.newton()) : "\u2013",
                                 figure(key + "peak_force", peak, short_text(peak))};
        if (run.job) {
            const double height = reference_offset(layers_of(run.job->force), number) / units.mm();
            row.push_back(fixed_text(100 * work.peak / run.job->force.max, 0) + " %");
            row.push_back(short_text(height));
        }
        for (const int count : {work.raised, work.lowered, work.re_cuts}) row.push_back(count_text(count));
        rows.push_back(row);
    }
    return table("Layers, from the lowest. Height: of the layer's reference over the desired surface. A force beyond "
                 "the largest raises the wheel by a layer.",
                 names, rows, 1);
}

Html time_shares(const Figures& n)
{
    const double whole = n.at("machine_time");
    Html bar, key;
    const std::pair<const char*, std::pair<const char*, const char*>> parts[] = {
        {"a", {"grinding_time", "grinding"}},
        {"b", {"travel_time", "travel"}},
        {"c", {"service_time", "wheel service"}}};
    for (const auto& [style, part] : parts) {
        const double share = whole > 0 ? n.at(part.first) / whole : 0;
        bar += element("i", {{"class", style}, {"style", "width:" + fixed_text(100 * share, 2) + "%"}});
        key += element(
            "li", element("i", Attributes{{"class", style}}) + std::string(part.second) + " " +
                      figure("grinding." + std::string(part.first), n.at(part.first), duration_text(n.at(part.first))) +
                      " (" + fixed_text(100 * share, 0) + " %)");
    }
    return element("div", {{"class", "share"}}, bar) + element("ul", {{"class", "key"}}, key);
}

Html totals(const RunFiles& run)
{
    const Figures& n = run.grinding->numbers;
    const std::string length = to_string(run.units.length), force = to_string(run.units.force);
    const auto number = [&](const char* key) {
        return figure("grinding." + std::string(key), n.at(key), short_text(n.at(key)));
    };
    const auto count = [&](const char* key) {
        return figure("grinding." + std::string(key), n.at(key), count_text(n.at(key)));
    };
    Html peak = number("peak_force") + " " + force;
    if (run.job)
        peak += " (" + fixed_text(100 * n.at("peak_force") * run.units.newton() / run.job->force.max, 0) + " % of " +
                symbol("F_max") + ")";
    const Html left = facts({{"Removed", number("removed_volume") + " " + length + "\u00B3"},
                             {"Peak force", peak},
                             {"Layers, the highest", count("layers")},
                             {"Coverings of layer 1", count("coverings")}});
    const Html right = facts({{"Passes begun", count("passes")},
                              {"Force readings", count("steps")},
                              {"Wheel measured, changed", count("touch_offs") + ", " + count("wheel_changes")},
                              {"Wheel radius at the end", number("wheel_radius") + " " + length}});
    return element("p",
                   "Machine time " +
                       figure("grinding.machine_time", n.at("machine_time"), duration_text(n.at("machine_time"))) +
                       (run.grinding->finished ? ", finished." : ", not finished: a bound of the plan was reached.")) +
           time_shares(n) + element("div", {{"class", "columns"}}, left + right);
}

} // namespace

Html grinding_section(const RunFiles& run)
{
    Html html;
    if (run.grinding) html += totals(run);
    if (run.trace) {
        html +=
            drawing_with_caption(trace_chart(*run.trace, run.job, run.units), "Force, layer and feed against time.");
        html += layer_table(run);
    }
    return section("grinding", "Grinding", html);
}

} // namespace fettle
