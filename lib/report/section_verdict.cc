#include "draw/figures.h"
#include "report/charts.h"
#include "report/sections.h"
#include "report/verdict.h"
#include "strategy/force_record.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

draw::Html tile(const draw::Html& value, const std::string& label)
{
    return draw::element("li", draw::element("b", value) + draw::element("span", {{"class", "label"}}, label));
}

draw::Html card(const std::string& style, const std::string& sign, const std::string& head, const draw::Html& text)
{
    return draw::element("div", {{"class", "verdict " + style}, {"data-verdict", head}},
                         draw::element("span", {{"class", "sign"}, {"aria-hidden", "true"}}, sign) +
                             draw::element("div", draw::element("strong", head) + draw::element("p", text)));
}

std::string judged_area(const ComparisonReport& comparison)
{
    return comparison.judged == "inside" ? "inside the boundary B" : "on the whole part";
}

/// What the part lacked before it was ground, and whether that counts.
draw::Html lacking_text(const PageVerdict& verdict, const auto& length)
{
    const OverCut& cut = *verdict.over_cut;
    draw::Html text = " " + draw::count_text(double(cut.lacking_points)) +
                      (cut.lacking_points == 1 ? " point" : " points") +
                      " lay below the reference before grinding, by up to ";
    text += length("over_cut.lacked", cut.lacked);
    return text + (verdict.by_wheel ? ": judged is what the wheel did, not what the part lacked already."
                                    : ": that counts here, too.");
}

draw::Html judged_card(const ComparisonReport& c, const PageVerdict& verdict, const std::string& unit)
{
    const NamedNumbers& numbers = c.region(c.judged);
    const int decimals = draw::decimals_for(std::max(verdict.tolerance, verdict.worst));
    const auto length = [&](const char* key, double value) {
        return draw::number_element(key, value, draw::fixed_text(value, decimals)) + " " + unit;
    };
    if (!std::isfinite(c.worst) || numbers.at("count") == 0)
        return card("out", "\u2717", "Out of tolerance", "No point " + judged_area(c) + " has an error to judge.");
    const bool is_over_cut =
        verdict.by_wheel ? verdict.over_cut->by_wheel > verdict.over_cut->left : -numbers.at("min") > numbers.at("max");
    const std::string side = !is_over_cut ? "material left" : verdict.by_wheel ? "over-cut by the wheel" : "over-cut";
    draw::Html text = "Largest error " + judged_area(c) + ": ";
    text += length(verdict.by_wheel ? "judged.worst" : "comparison.worst", verdict.worst) + " (" +
            (c.reversed ? "of both directions" : side) + "), allowed \u00B1" +
            length("comparison.tolerance", c.tolerance);
    const double reserve = c.tolerance - verdict.worst;
    text += (verdict.within ? "; to spare " : "; exceeded by ") +
            draw::Html(draw::fixed_text(std::abs(reserve), decimals) + " " + unit) + ".";
    if (verdict.over_cut && verdict.over_cut->lacking_points > 0) text += lacking_text(verdict, length);
    return verdict.within ? card("within", "\u2713", "Within tolerance", text)
                          : card("out", "\u2717", "Out of tolerance", text);
}

draw::Html tiles(const RunFiles& run, const PageVerdict& verdict)
{
    const std::string length = units::to_string(run.units.length);
    draw::Html items;
    if (run.comparison) {
        const ComparisonReport& c = *run.comparison;
        const std::string name = c.judged.empty() ? "all" : c.judged;
        const std::string key = name == "all" ? "comparison." : "comparison.regions." + name + ".";
        const NamedNumbers& n = c.region(name);
        const int decimals = draw::decimals_for(std::max(-n.at("min"), n.at("max")));
        const auto error_tile = [&](const std::string& number_key, double value, const std::string& label) {
            items +=
                tile(draw::number_element(number_key, value, draw::fixed_text(value, decimals)) + " " + length, label);
        };
        error_tile(key + "mean_abs", n.at("mean_abs"), "mean absolute error");
        if (verdict.over_cut) {
            error_tile("over_cut.by_wheel", verdict.over_cut->by_wheel, "deepest over-cut by the wheel");
            if (verdict.over_cut->lacking_points > 0)
                error_tile("over_cut.lacked", verdict.over_cut->lacked, "most that was lacking before grinding");
        } else {
            error_tile(key + "min", n.at("min"), "deepest over-cut");
        }
        error_tile(key + "max", n.at("max"), "maximum material left");
    }
    if (run.grinding) {
        const NamedNumbers& n = run.grinding->numbers;
        items +=
            tile(number_figure("grinding.removed_volume", n.at("removed_volume")) + " " + length + "\u00B3", "removed");
        items += tile(draw::number_element("grinding.machine_time", n.at("machine_time"),
                                           draw::duration_text(n.at("machine_time"))),
                      "machine time");
    }
    if (run.surface && run.surface->touches.cols() > 0)
        items += tile(draw::count_text(double(run.surface->touches.cols())), "touches");
    return items.empty() ? draw::Html() : draw::element("ul", {{"class", "tiles"}}, items);
}

/// Warns of a force far above F_max, with its place; empty if there was none.
draw::Html force_card(const RunFiles& run)
{
    if (!run.grinding || !run.job) return {};
    const double peak = run.grinding->numbers.at("peak_force"), max = run.job->force.max / run.units.newton();
    if (!(peak > strategy::kMaxPeakShare * max)) return {};
    const std::string force = " " + units::to_string(run.units.force);
    draw::Html text = "Peak force " + number_figure("grinding.peak_force", peak) + force + ", " +
                      draw::fixed_text(100 * peak / max, 0) + " % of " + draw::symbol_with_subscript("F_max") + " (" +
                      draw::short_text(max) + force + ")";
    if (const Eigen::VectorXd& at = run.grinding->peak_at; at.size() > 0)
        text += ", at x " + draw::short_text(at.x()) + ", y " + draw::short_text(at.y()) + ", z " +
                draw::short_text(at.z()) + " " + units::to_string(run.units.length);
    return card("force", "!", "Force above the limit", text + ".");
}

} // namespace

draw::Html verdict_section(const RunFiles& run)
{
    const std::string unit = units::to_string(run.units.length);
    const PageVerdict verdict = judge_page(run);
    draw::Html html;
    if (run.comparison && !run.comparison->judged.empty()) {
        const ComparisonReport& c = *run.comparison;
        html += judged_card(c, verdict, unit);
        html += drawing_with_caption(
            error_gauge(c.region(c.judged), c.tolerance, unit),
            "Errors " + judged_area(c) +
                " against the tolerance: whole range (line), 1st to 99th percentile (bar), mean (circle).");
    } else {
        html += card("", "\u2013", "Not judged",
                     run.comparison ? "The comparison has no tolerance." : "There is no comparison with a reference.");
    }
    if (run.grinding && !run.grinding->finished)
        html += card("out", "!", "Grinding not finished", "The machine stopped at a limit of the plan.");
    html += force_card(run);
    return draw::element("section", {{"id", "verdict"}}, html + tiles(run, verdict)) + draw::Html::from_markup("\n");
}

} // namespace fettle::report
