#include "calibrate/trials_csv.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::calibrate {
namespace {

using removal::RemovalTrial;

struct Column {
    const char* name;
    double RemovalTrial::*value;
    bool is_required;
};
constexpr Column kColumns[] = {
    {"avg_force_N", &RemovalTrial::force, true},        {"initial_wear", &RemovalTrial::prior_work, true},
    {"removed_mm3", &RemovalTrial::volume, true},       {"avg_rpm", &RemovalTrial::speed, false},
    {"feed_rate_setpoint", &RemovalTrial::feed, false}, {"grind_time_s", &RemovalTrial::duration, false}};

std::vector<std::string> cells_of(std::string_view line)
{
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

/// Index of a column; the number of columns if it is missing.
std::size_t find_column(const std::vector<std::string>& names, const std::string& name)
{
    return std::ranges::find(names, name) - names.begin();
}

/// @throws InputError if the value is no positive number; prior work may be 0
double parse_value(const std::string& cell, const Column& column)
{
    const auto value = core::parse_number(cell);
    const bool may_be_zero = column.value == &RemovalTrial::prior_work;
    if (!value || !std::isfinite(*value) || !(*value > 0 || (may_be_zero && *value == 0)))
        throw core::InputError(std::string(column.name) + " is not a positive number, got " + cell);
    return *value;
}

} // namespace

Trials read_trials(std::string_view csv, const std::string& source)
{
    Trials trials;
    std::vector<std::string> names;
    for (core::Lines lines(csv); lines.next();) {
        if (lines.line().empty() || lines.line().front() == '#') continue;
        const std::vector<std::string> cells = cells_of(lines.line());
        if (names.empty()) {
            names = cells;
            for (const Column& column : kColumns)
                if (column.is_required && find_column(names, column.name) == names.size())
                    throw core::InputError(source, lines.location() + ": no column " + column.name);
            continue;
        }
        if (cells.size() != names.size())
            throw core::InputError(source, lines.location() + ": " + std::to_string(cells.size()) + " values, not " +
                                               std::to_string(names.size()));
        RemovalTrial trial;
        for (const Column& column : kColumns) {
            const std::size_t index = find_column(names, column.name);
            try {
                trial.*column.value = index == names.size() ? std::numeric_limits<double>::quiet_NaN()
                                                            : parse_value(cells[index], column);
            } catch (const core::InputError& error) {
                throw core::InputError(source, lines.location() + ": " + error.what());
            }
        }
        trials.all.push_back(trial);
        const std::size_t exact = find_column(names, "exact");
        if (exact == names.size() || cells[exact] == "1") trials.exact.push_back(trial);
    }
    if (trials.exact.empty()) throw core::InputError(source, "no row with an exact volume");
    std::ranges::stable_sort(trials.exact, {}, &RemovalTrial::prior_work);
    return trials;
}

double typical_pass_work(const RemovalTrial& trial)
{
    constexpr double kTypicalTravel = 9000 * 10; // revolutions a minute, times s
    const double work = trial.force * trial.speed * trial.duration;
    return std::isnan(work) ? trial.force * kTypicalTravel : work;
}

} // namespace fettle::calibrate
