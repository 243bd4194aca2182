#pragma once

#include "removal/removal_fit.h"

#include <string>
#include <string_view>
#include <vector>

namespace fettle::calibrate {

/// Rows of measured trials.
struct Trials {
    std::vector<removal::RemovalTrial> exact; ///< in the order of the belt's work
    std::vector<removal::RemovalTrial> all;   ///< and those that say bounds, in the order of the file
};

/// Reads rows with a header of names: avg_force_N, initial_wear and removed_mm3; grind_time_s, avg_rpm and
/// feed_rate_setpoint as far as they were recorded. With a column exact, rows where it is not 1 say bounds. Lines that
/// begin with # and other columns are ignored.
/// @throws InputError naming the line
Trials read_trials(std::string_view csv, const std::string& source);

/// Work of a typical pass in the unit of a trial's prior work, force · speed · duration. Where speed or duration were
/// not recorded it is that of a common belt grinder, 9000 revolutions a minute for 10 s.
double typical_pass_work(const removal::RemovalTrial& trial);

} // namespace fettle::calibrate
