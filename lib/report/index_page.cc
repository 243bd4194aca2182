#include "report/index_page.h"

#include "core/error.h"
#include "core/text.h"
#include "draw/figures.h"
#include "draw/svg.h"
#include "report/sections.h"
#include "report/style.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle::report {
namespace {

using draw::svg::Anchor;

constexpr const char* kIndexStyle = R"css(<style>
body { max-width: 76rem; }
table.parts td { vertical-align: middle; }
table.parts img { display: block; width: 132px; height: auto; max-height: 100px; object-fit: contain; }
table.parts th button { font: inherit; font-weight: 600; color: inherit; background: none; border: 0; padding: 0; cursor: pointer; text-align: inherit; }
table.parts th[aria-sort="ascending"] button::after { content: " \25B2"; }
table.parts th[aria-sort="descending"] button::after { content: " \25BC"; }
table.parts a { color: var(--blue); overflow-wrap: anywhere; }
@media (max-width: 40rem) { table.parts img { width: 84px; } table.parts td:nth-child(3) { min-width: 6rem; } }
.verdict-within { color: var(--green); } .verdict-out { color: #b34700; font-weight: 650; }
svg .dot { fill: var(--green); } svg .dot-out { fill: var(--orange); stroke: var(--ink); stroke-width: .6; } svg .dot-none { fill: var(--soft); }
svg .series { fill: none; stroke: #b4bdc5; stroke-width: 1; }
.trends { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 0 1.6rem; }
</style>
)css";

constexpr const char* kIndexScript = R"js(<script>//<![CDATA[
"use strict";
(() => {
    const table = document.querySelector("table.parts"), body = table.tBodies[0];
    const value = (row, column) => row.cells[column].dataset.sort ?? row.cells[column].textContent;
    const compare = (a, b) => {
        const x = Number(a), y = Number(b);
        if (a !== "" && b !== "" && !Number.isNaN(x) && !Number.isNaN(y)) return x - y;
        return a === b ? 0 : a === "" ? 1 : b === "" ? -1 : a.localeCompare(b, undefined, { numeric: true });
    };
    table.tHead.addEventListener("click", event => {
        const head = event.target.closest("th");
        if (!head || !event.target.closest("button")) return;
        const column = head.cellIndex, descending = head.getAttribute("aria-sort") === "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", descending ? "descending" : "ascending");
        const keyed = [...body.rows].map(row => [value(row, column), row]);
        keyed.sort((a, b) => descending ? compare(b[0], a[0]) : compare(a[0], b[0]));
        body.append(...keyed.map(([, row]) => row));
    });
})();
//]]></script>
)js";

/// A number of a part in the units of the index; nothing if it is not known.
std::optional<double> number_of(const PageSummary& part, const std::string& key, const units::Units& units)
{
    const auto found = part.numbers.find(key);
    if (found == part.numbers.end() || !std::isfinite(found->second)) return std::nullopt;
    if (key == "machine_time") return found->second;
    if (key == "peak_force") return found->second * part.units.newton() / units.newton();
    return found->second * part.units.mm() / units.mm();
}

const char* dot_style(const PageSummary& part)
{
    return part.verdict == "within" ? "dot" : part.verdict == "not judged" ? "dot-none" : "dot-out";
}

/// One number over the series, a dot for each part, with the tolerance if all have the same.
draw::Html trend(const std::vector<PageSummary>& parts, const std::string& key, const std::string& label,
                 const units::Units& units, std::optional<double> limit)
{
    constexpr double kTrendWidth = 520, kTop = 26, kBottom = 150, kLeft = 62, kRight = 508, kHeight = 186;
    double low = 0, high = limit.value_or(0);
    for (const PageSummary& part : parts)
        if (const auto value = number_of(part, key, units)) {
            low = std::min(low, *value);
            high = std::max(high, *value);
        }
    if (!(high > low)) return {};
    const double margin = 0.06 * (high - low);
    const draw::svg::Axis x = {0.5, double(parts.size()) + 0.5, kLeft, kRight};
    const draw::svg::Axis y = {low < 0 ? low - margin : 0, high + margin, kBottom, kTop};
    draw::Html html = draw::svg::ticks_left(y, kLeft, kRight, 4) + draw::svg::text({kLeft, kTop - 10}, label);
    for (const std::size_t n : {std::size_t{1}, parts.size()})
        html += draw::svg::text({x(double(n)), kBottom + 18}, std::to_string(n), Anchor::middle);
    html += draw::svg::text({(kLeft + kRight) / 2, kBottom + 18}, "page", Anchor::middle);
    if (limit) html += draw::svg::line({kLeft, y(*limit)}, {kRight, y(*limit)}, "limit");
    std::string line;
    draw::Html dots;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto value = number_of(parts[i], key, units);
        if (!value) continue;
        const Eigen::Vector2d at(x(double(i + 1)), y(*value));
        line += (line.empty() ? "M" : "L") + draw::svg::coordinate(at.x()) + " " + draw::svg::coordinate(at.y());
        dots += draw::svg::circle(at, parts.size() > 100 ? 2 : 3.2, dot_style(parts[i]));
    }
    return draw::element("figure", draw::svg::drawing(kTrendWidth, kHeight, label + " of each page, in their order",
                                                      html + draw::svg::path(line, "series") + dots));
}

// Relative: tolerances that differ by less are the same, converted from another unit.
constexpr double kMaxUnitRounding = 1e-9;

/// The tolerance, if all judged parts have the same.
std::optional<double> common_tolerance(const std::vector<PageSummary>& parts, const units::Units& units)
{
    std::optional<double> common;
    for (const PageSummary& part : parts)
        if (const auto tolerance = number_of(part, "tolerance", units)) {
            if (common && std::abs(*common - *tolerance) > kMaxUnitRounding * *common) return std::nullopt;
            common = tolerance;
        }
    return common;
}

/// Names of the head's fields, in the order in which they come.
std::vector<std::string> field_names(const std::vector<PageSummary>& parts)
{
    std::vector<std::string> names;
    for (const PageSummary& part : parts)
        for (const auto& [name, value] : part.head)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
}

draw::Html cell(const draw::Html& content, const std::string& sort, bool is_number)
{
    draw::Attributes attributes = {{"data-sort", sort}};
    if (is_number) attributes.emplace_back("class", "number");
    return draw::element("td", attributes, content);
}

draw::Html number_cell(const std::optional<double>& value, const std::string& text)
{
    return value ? cell(text, core::to_text(*value), true) : cell("\u2013", "", true);
}

draw::Html row_of(const PageSummary& part, std::size_t number, const std::string& link,
                  const std::vector<std::string>& names, const units::Units& units)
{
    const draw::Html picture =
        part.thumbnail.empty()
            ? draw::Html()
            : draw::empty_element(
                  "img", {{"alt", "errors"}, {"loading", "lazy"}, {"src", "data:image/png;base64," + part.thumbnail}});
    draw::Html row = cell(std::to_string(number), std::to_string(number), true) + draw::element("td", picture) +
                     cell(draw::element("a", {{"href", link}}, part.title), part.title, false);
    for (const std::string& name : names) {
        const auto found = std::ranges::find(part.head, name, &std::pair<std::string, std::string>::first);
        const std::string value = found == part.head.end() ? "" : found->second;
        row += cell(value, value, false);
    }
    const bool within = part.verdict == "within", judged = part.verdict != "not judged";
    row += cell(draw::element("span",
                              {{"class", within   ? "verdict-within"
                                         : judged ? "verdict-out"
                                                  : ""}},
                              (within   ? "\u2713 "
                               : judged ? "\u2717 "
                                        : "") +
                                  part.verdict),
                within   ? "0"
                : judged ? "1"
                         : "2",
                false);
    for (const char* key : {"worst", "mean", "tolerance"}) {
        const auto value = number_of(part, key, units);
        row += number_cell(value, value ? draw::short_text(*value) : "");
    }
    const auto time = number_of(part, "machine_time", units);
    return draw::element("tr", row + number_cell(time, time ? draw::duration_text(*time) : ""));
}

draw::Html parts_table(const std::vector<PageSummary>& parts, const std::vector<std::string>& links,
                       const units::Units& units)
{
    const std::string length = ", " + units::to_string(units.length);
    const std::vector<std::string> names = field_names(parts);
    draw::Html head;
    const auto add = [&](const std::string& name, bool is_number, bool sorts = true) {
        const draw::Html label = sorts ? draw::element("button", {{"type", "button"}}, name) : draw::Html(name);
        head += draw::element("th", is_number ? draw::Attributes{{"class", "number"}} : draw::Attributes{}, label);
    };
    add("No.", true);
    add("", false, false);
    add("Page", false);
    for (const std::string& name : names) add(name, false);
    add("Verdict", false);
    for (const char* name : {"Worst", "Mean", "Tolerance"}) add(name + length, true);
    add("Time", true);
    draw::Html body;
    for (std::size_t i = 0; i < parts.size(); ++i) body += row_of(parts[i], i + 1, links[i], names, units);
    return draw::element(
        "div", {{"class", "scroll"}},
        draw::element("table", {{"class", "parts"}},
                      draw::element("thead", draw::element("tr", head)) + draw::element("tbody", body)));
}

std::string counts_text(const std::vector<PageSummary>& parts)
{
    const auto count = [&](const char* verdict) { return std::ranges::count(parts, verdict, &PageSummary::verdict); };
    std::string text = std::to_string(parts.size()) + (parts.size() == 1 ? " page: " : " pages: ") +
                       std::to_string(count("within")) + " within tolerance, " +
                       std::to_string(count("out of tolerance")) + " out of tolerance";
    if (const auto others = count("not judged"); others > 0) text += ", " + std::to_string(others) + " not judged";
    return text;
}

} // namespace

std::string index_page(const std::vector<PageSummary>& parts, const std::vector<std::string>& links,
                       const std::string& title, const std::string& version)
{
    if (parts.empty()) throw core::InputError("--index", "no page is named");
    const units::Units units = parts.front().units;
    const std::string headline = title.empty() ? "Parts" : title, length = ", " + units::to_string(units.length);
    const std::optional<double> tolerance = common_tolerance(parts, units);
    draw::Html trends = trend(parts, "worst", "largest error" + length, units, tolerance);
    trends += trend(parts, "mean", "mean error" + length, units, std::nullopt);
    trends += trend(parts, "machine_time", "machine time, s", units, std::nullopt);
    trends += trend(parts, "peak_force", "peak force, " + units::to_string(units.force), units, std::nullopt);
    const draw::Html head =
        draw::empty_element("meta", {{"charset", "utf-8"}}) +
        draw::empty_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
        draw::element("title", headline) + style_sheet() + draw::Html::from_markup(kIndexStyle);
    const draw::Html body =
        draw::element("header", draw::element("h1", headline) + draw::element("p", counts_text(parts))) +
        section("trends", "The series", draw::element("div", {{"class", "trends"}}, trends)) +
        section("parts", "Pages", parts_table(parts, links, units)) +
        draw::element("footer", "Written by fettle-report " + version + ".") + draw::Html::from_markup(kIndexScript);
    return "<!DOCTYPE html>\n" +
           draw::element("html", {{"lang", "en"}}, draw::element("head", head) + draw::element("body", body)).bytes() +
           "\n";
}

} // namespace fettle::report
