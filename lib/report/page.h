#pragma once

#include "report/run_files.h"

#include <string>

namespace fettle {

/// One self-contained page (HTML 5, UTF-8) about a run: verdict, job, touches and fit, margin, plan, grinding, maps,
/// statistics, provenance. What was not read is left out. Every number that an input holds carries its key and its full
/// value (`data-key`, `data-value`). The same bytes for the same input.
/// @param title  headline; empty: a plain one   @param version  of the suite
/// @throws InputError if a part or an error map has no point that can be drawn
std::string report_page(const RunFiles& run, const std::string& title, const std::string& version);

} // namespace fettle
