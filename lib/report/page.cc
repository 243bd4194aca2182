#include "report/page.h"

#include "draw/figures.h"
#include "report/sections.h"
#include "report/style.h"
#include "view/view.h"

#include <filesystem>

namespace fettle::report {

draw::Html provenance_section(const RunFiles& run)
{
    std::vector<std::vector<draw::Html>> rows;
    for (const SourceFile& file : run.sources)
        rows.push_back({file.role,
                        draw::element("span", {{"class", "name"}}, file.name) + draw::empty_element("br", {}) +
                            draw::element("span", {{"class", "hash"}}, file.sha256),
                        draw::count_text(double(file.bytes))});
    return section("provenance", "Provenance",
                   table("Source files of this page, with their SHA-256", {"Content", "File", "Bytes"}, rows, 2));
}

std::string headline_of(const RunFiles& run, const std::string& title)
{
    if (!title.empty()) return title;
    return run.grinding || run.trace || run.plan ? "Grinding report" : "Inspection report";
}

/// Part, serial number, operator, date and the like.
static draw::Html head_fields(const RunFiles& run)
{
    draw::Html items;
    for (const auto& [name, value] : run.head)
        items += draw::element("div", draw::element("dt", name) + draw::element("dd", value));
    return items.empty() ? items : draw::element("dl", {{"class", "head"}}, items);
}

std::string report_page(const RunFiles& run, const std::string& title, const std::string& version)
{
    const std::string headline = headline_of(run, title);
    draw::Html subtitle;
    if (run.job) subtitle += std::filesystem::path(run.job->source).filename().string() + " \u00B7 ";
    subtitle += "units: " + units::to_string(run.units.length) + ", " + units::to_string(run.units.force);
    const draw::Html head =
        draw::empty_element("meta", {{"charset", "utf-8"}}) +
        draw::empty_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
        draw::element("title", headline) + style_sheet() + view::view_style();
    draw::Html body =
        draw::element("header", draw::element("h1", headline) + draw::element("p", subtitle) + head_fields(run)) +
        draw::Html::from_markup("\n");
    for (const auto part : {verdict_section, job_section, fit_section, margin_section, plan_section, grinding_section,
                            registration_section, maps_section, statistics_section, form_section, provenance_section})
        body += part(run);
    body += draw::element("footer", "Written by fettle-report " + version +
                                        ". The page's source has the full value of each number.");
    if (run.before || run.after || run.errors) body += view::view_script();
    return "<!DOCTYPE html>\n" +
           draw::element("html", {{"lang", "en"}},
                         draw::element("head", head) + draw::Html::from_markup("\n") + draw::element("body", body))
               .bytes() +
           "\n";
}

} // namespace fettle::report
