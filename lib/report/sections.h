#pragma once

#include "draw/html.h"
#include "report/run_files.h"

#include <string>
#include <utility>
#include <vector>

/// The sections of a report page. A section without data is empty.
namespace fettle::report {

draw::Html verdict_section(const RunFiles& run);
draw::Html job_section(const RunFiles& run);
draw::Html fit_section(const RunFiles& run);
draw::Html margin_section(const RunFiles& run);
draw::Html plan_section(const RunFiles& run);
draw::Html grinding_section(const RunFiles& run);
draw::Html maps_section(const RunFiles& run);
draw::Html registration_section(const RunFiles& run);
draw::Html form_section(const RunFiles& run);
draw::Html statistics_section(const RunFiles& run);
draw::Html provenance_section(const RunFiles& run);

// --- elements of sections ---

/// A section with a heading; empty if its content is.
draw::Html section(const std::string& id, const std::string& heading, const draw::Html& content);
/// A table of two columns, name and value.
using Properties = std::vector<std::pair<std::string, draw::Html>>;
draw::Html property_table(const Properties& rows);
/// A table; the first column holds the names of the rows unless `numbers` is 0.
/// @param names  of the columns; may be empty   @param numbers  index of the first column with numbers, right-aligned
draw::Html table(const std::string& caption, const std::vector<draw::Html>& names,
                 const std::vector<std::vector<draw::Html>>& rows, std::size_t numbers);
draw::Html drawing_with_caption(const draw::Html& drawing, const std::string& caption);

/// A number with its key, shown with three digits, as a count, or with a unit, converted from mm or N: "0.4 in".
draw::Html number_figure(const std::string& key, double value);
draw::Html count_figure(const std::string& key, double count);
draw::Html length_figure(const std::string& key, double mm, const units::Units& units);
draw::Html force_figure(const std::string& key, double newton, const units::Units& units);

} // namespace fettle::report
