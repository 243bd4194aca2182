#pragma once

#include "fuzz.h"
#include "json/leaves.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

namespace fettle::fuzz {

/// Two JSON texts say the same, their numbers to what a change of units and back, or a turn, rounds off.
inline void require_same(const std::string& a, const std::string& b)
{
    constexpr double kRounding = 1e-9; // of the largest number; far above it, far below what anybody would notice
    const std::vector<json::Leaf> first = json::flatten(a, "first"), second = json::flatten(b, "second");
    require(first.size() == second.size(), "the documents have the same members");
    double largest = 0;
    for (const json::Leaf& leaf : first)
        if (const double* number = std::get_if<double>(&leaf.value)) largest = std::max(largest, std::abs(*number));
    for (std::size_t n = 0; n < first.size(); ++n) {
        require(first[n].path == second[n].path, "the documents have the same keys");
        const auto *x = std::get_if<double>(&first[n].value), *y = std::get_if<double>(&second[n].value);
        const bool same = x != nullptr && y != nullptr ? std::abs(*x - *y) <= kRounding * largest
                                                       : json::to_text(first[n]) == json::to_text(second[n]);
        require(same, first[n].path + " is the same");
    }
}

} // namespace fettle::fuzz
