#include "report/charts.h"
#include "report/figures.h"
#include "report/sections.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

Html tile(const Html& value, const std::string& label)
{
    return element("li", element("b", value) + element("span", {{"class", "label"}}, label));
}

Html card(const std::string& style, const std::string& sign, const std::string& head, const Html& text)
{
    return element("div", {{"class", "verdict " + style}, {"data-verdict", head}},
                   element("span", {{"class", "sign"}, {"aria-hidden", "true"}}, sign) +
                       element("div", element("strong", head) + element("p", text)));
}

std::string where(const ComparisonReport& comparison)
{
    return comparison.judged == "inside" ? "inside the boundary B" : "on the whole part";
}

Html judged_card(const ComparisonReport& c, const std::string& unit)
{
    const Figures& numbers = c.region(c.judged);
    const int decimals = decimals_for(std::max(c.tolerance, c.worst));
    const auto length = [&](const char* key, double value) {
        return figure(key, value, fixed_text(value, decimals)) + " " + unit;
    };
    if (!std::isfinite(c.worst) || numbers.at("count") == 0)
        return card("out", "\u2717", "Out of tolerance", "No point " + where(c) + " has an error to judge.");
    const std::string side = -numbers.at("min") > numbers.at("max") ? "over-cut" : "material left";
    Html text = "Largest error " + where(c) + ": ";
    text += length("comparison.worst", c.worst) + " (" + (c.reversed ? "of both directions" : side) +
            "), allowed \u00B1" + length("comparison.tolerance", c.tolerance);
    const double spare = c.tolerance - c.worst;
    text +=
        (c.within ? "; to spare " : "; exceeded by ") + Html(fixed_text(std::abs(spare), decimals) + " " + unit) + ".";
    return c.within ? card("within", "\u2713", "Within tolerance", text)
                    : card("out", "\u2717", "Out of tolerance", text);
}

Html tiles(const RunFiles& run)
{
    const std::string length = to_string(run.units.length);
    Html items;
    if (run.comparison) {
        const ComparisonReport& c = *run.comparison;
        const std::string name = c.judged.empty() ? "all" : c.judged;
        const std::string key = name == "all" ? "comparison." : "comparison.regions." + name + ".";
        const Figures& n = c.region(name);
        const int decimals = decimals_for(std::max(-n.at("min"), n.at("max")));
        items += tile(figure(key + "mean_abs", n.at("mean_abs"), fixed_text(n.at("mean_abs"), decimals)) + " " + length,
                      "mean size of the error");
        items += tile(figure(key + "min", n.at("min"), fixed_text(n.at("min"), decimals)) + " " + length,
                      "deepest over-cut");
        items += tile(figure(key + "max", n.at("max"), fixed_text(n.at("max"), decimals)) + " " + length,
                      "most material left");
    }
    if (run.grinding) {
        const Figures& n = run.grinding->numbers;
        items += tile(figure("grinding.removed_volume", n.at("removed_volume"), short_text(n.at("removed_volume"))) +
                          " " + length + "\u00B3",
                      "removed");
        items += tile(figure("grinding.machine_time", n.at("machine_time"), duration_text(n.at("machine_time"))),
                      "machine time");
    }
    if (run.surface && run.surface->touches.cols() > 0)
        items += tile(count_text(double(run.surface->touches.cols())), "touches");
    return items.empty() ? Html() : element("ul", {{"class", "tiles"}}, items);
}

} // namespace

Html verdict_section(const RunFiles& run)
{
    const std::string unit = to_string(run.units.length);
    Html html;
    if (run.comparison && !run.comparison->judged.empty()) {
        const ComparisonReport& c = *run.comparison;
        html += judged_card(c, unit);
        html += drawing_with_caption(
            error_gauge(c.region(c.judged), c.tolerance, unit),
            "Errors " + where(c) +
                " against the tolerance: whole range (line), 1st to 99th percentile (bar), mean (circle).");
    } else {
        html += card("", "\u2013", "Not judged",
                     run.comparison ? "The comparison has no tolerance." : "There is no comparison with a reference.");
    }
    if (run.grinding && !run.grinding->finished)
        html += card("out", "!", "Grinding not finished", "The machine stopped at a bound of the plan.");
    return element("section", {{"id", "verdict"}}, html + tiles(run)) + Html::markup("\n");
}

} // namespace fettle
