#include "report/summary.h"

#include "core/file.h"
#include "draw/base64.h"
#include "draw/picture.h"
#include "report/page.h"
#include "report/verdict.h"
#include "json/units.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::report {
namespace {

constexpr std::array<const char*, 3> kVerdicts = {"within", "out of tolerance", "not judged"};
constexpr std::array<const char*, 5> kNumbers = {"worst", "mean", "tolerance", "machine_time", "peak_force"};

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
        .set("verdict", !verdict.is_judged ? kVerdicts[2]
                        : verdict.within   ? kVerdicts[0]
                                           : kVerdicts[1]);
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

PageSummary read_page_summary(const std::string& path)
{
    json::Reader reader = json::Reader::parse(core::read_file(path, core::kMaxJsonBytes), core::display_name(path));
    reader.expect_kind("page");
    PageSummary summary;
    json::Reader stated = reader.object("units");
    summary.units.length = units::parse_length_unit(stated.choice("length", {"mm", "in", "m"}));
    if (stated.has("force")) summary.units.force = units::parse_force_unit(stated.choice("force", {"N", "lbf"}));
    summary.title = reader.text("title");
    summary.page = reader.text("page");
    for (const std::vector<std::string>& row : reader.text_rows("head", 2)) summary.head.emplace_back(row[0], row[1]);
    summary.verdict = reader.choice("verdict", {kVerdicts.begin(), kVerdicts.end()});
    for (const char* key : kNumbers)
        if (!reader.is_null_or_missing(key)) summary.numbers[key] = reader.number(key);
    for (const char* key : {"over_cut_by_wheel", "lacked"})
        if (!reader.is_null_or_missing(key)) reader.number(key);
    summary.thumbnail = reader.text_or("thumbnail", "");
    const auto is_base64 = [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '/' || c == '='; };
    if (!std::ranges::all_of(summary.thumbnail, is_base64)) reader.refuse("thumbnail", "is not base64");
    reader.reject_unknown_keys();
    return summary;
}

} // namespace fettle::report
