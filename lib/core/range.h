#pragma once

#include <limits>
#include <string>

namespace fettle {

/// The numbers that an option or a JSON member may have. NaN is never among them.
struct Range {
    double least = std::numeric_limits<double>::lowest();
    double most = std::numeric_limits<double>::max();
    bool least_itself = true; ///< is `least` allowed?
    bool most_itself = true;

    bool contains(double value) const;
    /// "finite", "positive", "at least 0", "in (0, 1)": what it says in messages and help.
    std::string text() const;

    static Range positive() { return {0, std::numeric_limits<double>::max(), false, true}; }
    static Range at_least(double least) { return {least, std::numeric_limits<double>::max(), true, true}; }
    static Range between(double least, double most) { return {least, most, true, true}; }
    static Range inside(double least, double most) { return {least, most, false, false}; }
};

} // namespace fettle
