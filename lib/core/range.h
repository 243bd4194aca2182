#pragma once

#include <limits>
#include <string>

namespace fettle::core {

/// Permitted values of an option or a JSON member. NaN is never permitted.
struct Range {
    double min = std::numeric_limits<double>::lowest();
    double max = std::numeric_limits<double>::max();
    bool includes_min = true;
    bool includes_max = true;

    bool contains(double value) const;
    /// Text for messages and help: "finite", "positive", "at least 0", "in (0, 1)".
    std::string text() const;

    static Range positive() { return {0, std::numeric_limits<double>::max(), false, true}; }
    static Range at_least(double min) { return {min, std::numeric_limits<double>::max(), true, true}; }
    static Range between(double min, double max) { return {min, max, true, true}; }
    static Range strictly_between(double min, double max) { return {min, max, false, false}; }
};

} // namespace fettle::core
