#pragma once

#include "report/run_files.h"

#include <string>

namespace fettle::report {

/// The headline of a page. @param title  empty: a default
std::string headline_of(const RunFiles& run, const std::string& title);

/// Self-contained report page (HTML 5, UTF-8) of a run: verdict, job, touches and fit, margin, plan, grinding, maps,
/// statistics, provenance. Sections without data are left out. Every number from an input has its key and its full
/// value as attributes (`data-key`, `data-value`). The output is deterministic.
/// @param title  headline; empty: a default   @param version  version of the suite
/// @throws InputError if a part or an error map has no point that can be drawn
std::string report_page(const RunFiles& run, const std::string& title, const std::string& version);

} // namespace fettle::report
