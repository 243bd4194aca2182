#pragma once

#include "report/html.h"
#include "report/run_files.h"

#include <string>
#include <utility>
#include <vector>

/// The sections of a page. Each is empty where the run has nothing to say in it.
namespace fettle {

Html verdict_section(const RunFiles& run);
Html job_section(const RunFiles& run);
Html fit_section(const RunFiles& run);
Html margin_section(const RunFiles& run);
Html plan_section(const RunFiles& run);
Html grinding_section(const RunFiles& run);
Html maps_section(const RunFiles& run);
Html registration_section(const RunFiles& run);
Html form_section(const RunFiles& run);
Html statistics_section(const RunFiles& run);
Html provenance_section(const RunFiles& run);

// --- what they are made of ---

Html section(const std::string& id, const std::string& heading, const Html& content);
/// A table of two columns: what, and how much.
using Facts = std::vector<std::pair<std::string, Html>>;
Html facts(const Facts& rows);
/// A table with a row of names, if there are any. The first column names the rows, but for a table of numbers alone.
/// @param numbers  the first column that holds numbers, which stand to the right
Html table(const std::string& caption, const std::vector<Html>& names, const std::vector<std::vector<Html>>& rows,
           std::size_t numbers);
Html drawing_with_caption(const Html& drawing, const std::string& caption);

/// "0.4 mm" with its key; lengths of the library, in mm.
Html length_figure(const std::string& key, double mm, const Units& units);
Html force_figure(const std::string& key, double newton, const Units& units);

} // namespace fettle
