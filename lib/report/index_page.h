#pragma once

#include "report/summary.h"

#include <string>
#include <vector>

namespace fettle::report {

/// One page about many parts: a row for each with its picture, verdict, largest and mean error, time, and a link to its
/// page; the rows can be sorted by any column. Above them what the series shows: the numbers in the order given.
/// @param links  of the pages, relative to this one   @throws InputError if there is no summary
std::string index_page(const std::vector<PageSummary>& parts, const std::vector<std::string>& links,
                       const std::string& title, const std::string& version);

} // namespace fettle::report
