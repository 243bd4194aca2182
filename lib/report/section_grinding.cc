#include "core/text.h"
#include "draw/base64.h"
#include "draw/figures.h"
#include "plan/layers.h"
#include "report/charts.h"
#include "report/sections.h"
#include "strategy/layer_switching.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fettle::report {
namespace {

using Eigen::Index;

/// Totals of a trace over one layer.
struct LayerWork {
    double time = 0;    ///< s
    double ground = 0;  ///< time with feed, s
    double impulse = 0; ///< ∫ force dt while grinding, N s
    double peak = 0;    ///< N
    int raised = 0, lowered = 0, re_cuts = 0;
};

std::map<int, LayerWork> layer_work(const cloud::Cloud& trace)
{
    const Eigen::VectorXd t = cloud::field(trace, "t"), force = cloud::field(trace, "force"),
                          feed = cloud::field(trace, "feed");
    const Eigen::VectorXd layer = cloud::field(trace, "layer"), event = cloud::field(trace, "event");
    std::map<int, LayerWork> layers;
    for (Index i = 0; i < t.size(); ++i) {
        LayerWork& work = layers[layer[i]];
        const double took = i == 0 ? t[i] : t[i] - t[i - 1];
        work.time += took;
        if (std::isfinite(force[i])) work.peak = std::max(work.peak, force[i]);
        if (feed[i] > 0) {
            work.ground += took;
            work.impulse += took * force[i];
        }
        work.raised += event[i] == static_cast<int>(strategy::Event::up);
        work.lowered += event[i] == static_cast<int>(strategy::Event::down);
        work.re_cuts += event[i] == static_cast<int>(strategy::Event::re_cut);
    }
    return layers;
}

draw::Html layer_table(const RunFiles& run)
{
    const units::Units& units = run.units;
    const std::string force = ", " + units::to_string(units.force);
    std::vector<draw::Html> names = {"Layer", "Time", "Grinding", "Mean force" + force, "Peak force" + force};
    if (run.job)
        names.insert(names.end(),
                     {"Peak of " + draw::symbol_with_subscript("F_max"), "Height, " + units::to_string(units.length)});
    for (const char* name : {"Raised to", "Lowered to", "Re-cuts"}) names.emplace_back(name);
    std::vector<std::vector<draw::Html>> rows;
    for (const auto& [number, work] : layer_work(*run.trace)) {
        const std::string key = "trace.layers." + std::to_string(number) + ".";
        const double peak = work.peak / units.newton();
        std::vector<draw::Html> row = {
            std::to_string(number), draw::number_element(key + "time", work.time, draw::duration_text(work.time)),
            draw::duration_text(work.ground),
            work.ground > 0 ? draw::short_text(work.impulse / work.ground / units.newton()) : "\u2013",
            number_figure(key + "peak_force", peak)};
        if (run.job) {
            const double height = plan::reference_offset(plan::compute_layers(run.job->force), number) / units.mm();
            row.push_back(draw::fixed_text(100 * work.peak / run.job->force.max, 0) + " %");
            row.push_back(draw::short_text(height));
        }
        for (const int count : {work.raised, work.lowered, work.re_cuts}) row.push_back(draw::count_text(count));
        rows.push_back(row);
    }
    return table("Layers, from the lowest. Height: of the layer's reference above the desired surface. A force above "
                 "the limit raises the wheel by one layer.",
                 names, rows, 1);
}

draw::Html time_shares(const NamedNumbers& n)
{
    const double total = n.at("machine_time");
    draw::Html bar, key;
    const std::pair<const char*, std::pair<const char*, const char*>> parts[] = {
        {"a", {"grinding_time", "grinding"}},
        {"b", {"travel_time", "travel"}},
        {"c", {"service_time", "wheel service"}}};
    for (const auto& [style, part] : parts) {
        const double share = total > 0 ? n.at(part.first) / total : 0;
        bar += draw::element("i", {{"class", style}, {"style", "width:" + draw::fixed_text(100 * share, 2) + "%"}});
        key += draw::element("li", draw::element("i", draw::Attributes{{"class", style}}) + std::string(part.second) +
                                       " " +
                                       draw::number_element("grinding." + std::string(part.first), n.at(part.first),
                                                            draw::duration_text(n.at(part.first))) +
                                       " (" + draw::fixed_text(100 * share, 0) + " %)");
    }
    return draw::element("div", {{"class", "share"}}, bar) + draw::element("ul", {{"class", "key"}}, key);
}

draw::Html totals(const RunFiles& run)
{
    const NamedNumbers& n = run.grinding->numbers;
    const std::string length = units::to_string(run.units.length), force = units::to_string(run.units.force);
    const auto number = [&](const char* key) { return number_figure("grinding." + std::string(key), n.at(key)); };
    const auto count = [&](const char* key) { return count_figure("grinding." + std::string(key), n.at(key)); };
    draw::Html peak = number("peak_force") + " " + force;
    if (run.job)
        peak += " (" + draw::fixed_text(100 * n.at("peak_force") * run.units.newton() / run.job->force.max, 0) +
                " % of " + draw::symbol_with_subscript("F_max") + ")";
    Properties first = {{"Removed", number("removed_volume") + " " + length + "\u00B3"},
                        {"Peak force", peak},
                        {"Highest layer", count("layers")},
                        {"Coverings of layer 1", count("coverings")}};
    if (const Eigen::VectorXd& at = run.grinding->peak_at; at.size() > 0) {
        first.insert(first.begin() + 2,
                     {"Its place", "layer " + count("peak_layer") + ", x " + draw::short_text(at.x()) + ", y " +
                                       draw::short_text(at.y()) + ", z " + draw::short_text(at.z())});
        first.emplace_back("Strokes back over a pass of layer 1", count("strokes"));
        if (n.at("contact_time") > 0)
            first.emplace_back("Force in range above layer 1", draw::fixed_text(100 * n.at("in_range"), 0) + " % of " +
                                                                   draw::duration_text(n.at("contact_time")) +
                                                                   " in contact");
    }
    const draw::Html left = property_table(first);
    const draw::Html right =
        property_table({{"Passes started", count("passes")},
                        {"Force readings", count("steps")},
                        {"Wheel measurements, changes", count("touch_offs") + ", " + count("wheel_changes")},
                        {"Wheel radius at the end", number("wheel_radius") + " " + length}});
    return draw::element(
               "p", "Machine time " +
                        draw::number_element("grinding.machine_time", n.at("machine_time"),
                                             draw::duration_text(n.at("machine_time"))) +
                        (run.grinding->finished ? ", finished." : ", not finished: a limit of the plan was reached.")) +
           time_shares(n) + draw::element("div", {{"class", "columns"}}, left + right);
}

// Steps through the pictures, and through the force trace above them if the page has one.
constexpr const char* kPlayerScript = R"js(<script>//<![CDATA[
"use strict";
(() => {
    const player = document.querySelector(".player"), image = player.querySelector("img"), range = player.querySelector("input"), button = player.querySelector("button");
    const frames = [...player.querySelectorAll("[data-t]")].map(frame => ({ t: Number(frame.dataset.t), picture: frame.textContent }));
    const time = player.querySelector("output"), axis = document.querySelector("rect.time-axis"), cursor = document.querySelector("line.cursor");
    let timer;
    const show = index => {
        range.value = index;
        image.src = "data:image/png;base64," + frames[index].picture;
        time.textContent = frames[index].t.toFixed(1) + " s";
        player.dataset.shown = index;
        if (!axis) return;
        const x = Number(axis.getAttribute("x")) + Math.min(1, frames[index].t / Number(axis.dataset.seconds)) * Number(axis.getAttribute("width"));
        cursor.setAttribute("x1", x);
        cursor.setAttribute("x2", x);
        cursor.style.visibility = "visible";
    };
    const stop = () => { clearInterval(timer); timer = undefined; button.textContent = "\u25B6 Play"; };
    button.addEventListener("click", () => {
        if (timer) { stop(); return; }
        if (Number(range.value) === frames.length - 1) show(0);
        button.textContent = "\u23F8 Pause";
        timer = setInterval(() => Number(range.value) < frames.length - 1 ? show(Number(range.value) + 1) : stop(), 250);
    });
    range.addEventListener("input", () => { stop(); show(Number(range.value)); });
    show(frames.length - 1);
})();
//]]></script>)js";

/// The pictures of the stock, to be played; without a script the last of them.
draw::Html player(const PlayedFrames& played)
{
    const std::string last = std::to_string(played.frames.size() - 1);
    draw::Html data;
    for (const PlayedFrames::Frame& frame : played.frames)
        data += draw::element("script", {{"type", "text/plain"}, {"data-t", core::to_text(frame.time)}},
                              draw::Html::from_markup(draw::base64(frame.png)));
    const draw::Html controls = draw::element("div", {{"class", "controls"}},
                                              draw::element("button", {{"type", "button"}}, "\u25B6 Play") +
                                                  draw::empty_element("input", {{"type", "range"},
                                                                                {"min", "0"},
                                                                                {"max", last},
                                                                                {"value", last},
                                                                                {"aria-label", "picture of the run"}}) +
                                                  draw::element("output", draw::Html()));
    const draw::Html picture = draw::empty_element(
        "img", {{"alt", played.shown}, {"src", "data:image/png;base64," + draw::base64(played.frames.back().png)}});
    return draw::element("figure", {{"class", "player"}},
                         controls + picture + data + draw::element("figcaption", played.shown)) +
           draw::Html::from_markup(kPlayerScript);
}

std::string trace_caption(const RunFiles& run)
{
    std::string caption = "Force, layer and feed against time";
    if (!run.grinding || !run.job) return caption + ".";
    const double peak = run.grinding->numbers.at("peak_force"), max = run.job->force.max / run.units.newton();
    return caption + ": the highest force, " + draw::short_text(peak) + " " + units::to_string(run.units.force) +
           ", is " + draw::fixed_text(100 * peak / max, 0) + " % of the limit that the job sets.";
}

} // namespace

draw::Html grinding_section(const RunFiles& run)
{
    draw::Html html;
    if (run.grinding) html += totals(run);
    if (run.trace) {
        html += drawing_with_caption(trace_chart(*run.trace, run.job, run.units), trace_caption(run));
        html += layer_table(run);
    }
    if (run.frames) html += player(*run.frames);
    return section("grinding", "Grinding", html);
}

} // namespace fettle::report
