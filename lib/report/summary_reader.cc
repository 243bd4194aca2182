#include "core/file.h"
#include "report/summary.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fettle::report {
namespace {

constexpr std::array<const char*, 5> kNumbers = {"worst", "mean", "tolerance", "machine_time", "peak_force"};

} // namespace

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
    summary.verdict = reader.choice("verdict", {kPageVerdicts.begin(), kPageVerdicts.end()});
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
