#pragma once

#include "report/run_files.h"
#include "json/document.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace fettle::report {

inline constexpr std::array<const char*, 3> kPageVerdicts = {"within", "out of tolerance", "not judged"};

/// What an index of many pages says of one of them.
struct PageSummary {
    std::string title, page; ///< headline; file of the page, relative to the summary's folder
    std::vector<std::pair<std::string, std::string>> head;
    std::string verdict; ///< one of kPageVerdicts
    units::Units units;
    NamedNumbers numbers;  ///< worst, mean, tolerance, machine_time, peak_force: those that are known; in `units`
    std::string thumbnail; ///< PNG in base64; empty: none
};

/// The summary of a page, JSON of kind "page". @param page  file name of the page
json::Value page_summary(const RunFiles& run, const std::string& title, const std::string& page);

/// Reads such a summary. @throws InputError
PageSummary read_page_summary(const std::string& path);

} // namespace fettle::report
