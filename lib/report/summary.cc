#include "report/summary.h"

#include "draw/base64.h"
#include "draw/picture.h"
#include "report/page.h"
#include "report/verdict.h"
#include "json/units.h"

namespace fettle::report {
namespace {

/// A small picture of the errors, or of the part after or before.
std::string thumbnail(const RunFiles& run)
{
    draw::PictureOptions options;
    constexpr int kWidth = 132, kBands = 16; // few colours: a page of 500 pictures stays small
    options.width = kWidth;
    options.bands = kBands;
    options.units = run.units;
    options.job = run.job;
    if (run.errors) {
        options.field = "error";
        if (run.comparison && run.comparison->tolerance > 0) options.scale = run.comparison->tolerance;
        return draw::map_picture(*run.errors, options);
    }
    const auto& part = run.after ? run.after : run.before;
    return part ? draw::map_picture(*part, options) : "";
}

} // namespace

json::Value page_summary(const RunFiles& run, const std::string& title, const std::string& page)
{
    const PageVerdict verdict = judge_page(run);
    std::vector<json::Value> head;
    for (const auto& [name, value] : run.head) head.push_back(std::vector<json::Value>{name, value});
    json::Value summary;
    summary.set("kind", "page")
        .set("units", json::to_json(run.units))
        .set("title", headline_of(run, title))
        .set("page", page)
        .set("head", head)
        .set("verdict", !verdict.is_judged ? kPageVerdicts[2]
                        : verdict.within   ? kPageVerdicts[0]
                                           : kPageVerdicts[1]);
    if (verdict.is_judged) summary.set("worst", verdict.worst).set("tolerance", verdict.tolerance);
    if (run.comparison)
        summary.set("mean", run.comparison->region(verdict.is_judged ? run.comparison->judged : "all").at("mean"));
    if (verdict.over_cut)
        summary.set("over_cut_by_wheel", verdict.over_cut->by_wheel).set("lacked", verdict.over_cut->lacked);
    if (run.grinding)
        summary.set("machine_time", run.grinding->numbers.at("machine_time"))
            .set("peak_force", run.grinding->numbers.at("peak_force"));
    return summary.set("thumbnail", draw::base64(thumbnail(run)));
}

} // namespace fettle::report
