#include "report/page.h"

#include "report/figures.h"
#include "report/sections.h"
#include "report/style.h"

#include <filesystem>

namespace fettle {

Html provenance_section(const RunFiles& run)
{
    std::vector<std::vector<Html>> rows;
    for (const SourceFile& file : run.sources)
        rows.push_back({file.what,
                        element("span", {{"class", "name"}}, file.name) + lone_element("br", {}) +
                            element("span", {{"class", "hash"}}, file.sha256),
                        count_text(double(file.bytes))});
    return section("provenance", "Provenance",
                   table("Files that this page was made from, with their SHA-256", {"What", "File", "Bytes"}, rows, 2));
}

std::string report_page(const RunFiles& run, const std::string& title, const std::string& version)
{
    const std::string headline = !title.empty()                          ? title
                                 : run.grinding || run.trace || run.plan ? "Grinding report"
                                                                         : "Inspection report";
    Html subtitle;
    if (run.job) subtitle += std::filesystem::path(run.job->source).filename().string() + " \u00B7 ";
    subtitle += "units: " + to_string(run.units.length) + ", " + to_string(run.units.force);
    const Html head = lone_element("meta", {{"charset", "utf-8"}}) +
                      lone_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
                      element("title", headline) + style_sheet();
    Html body = element("header", element("h1", headline) + element("p", subtitle)) + Html::markup("\n");
    for (const auto part : {verdict_section, job_section, fit_section, margin_section, plan_section, grinding_section,
                            registration_section, maps_section, statistics_section, form_section, provenance_section})
        body += part(run);
    body += element("footer",
                    "Written by fettle-report " + version + ". Numbers carry their full value in the page's source.");
    return "<!DOCTYPE html>\n" +
           element("html", {{"lang", "en"}}, element("head", head) + Html::markup("\n") + element("body", body))
               .bytes() +
           "\n";
}

} // namespace fettle
