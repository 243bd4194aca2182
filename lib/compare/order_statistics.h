#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace fettle {

/// Numbers too many to hold: calls its argument with all of them, some at a time, in a fixed order, as often as wanted.
using Numbers = std::function<void(const std::function<void(std::span<const double>)>&)>;

/// The numbers that would stand at `ranks` (0: the smallest) if they were sorted, found in four passes that each tell
/// 16 bits more of them (radix selection). @param ranks  below their count; none of them is NaN
std::vector<double> order_statistics(const Numbers& numbers, const std::vector<std::size_t>& ranks);

} // namespace fettle
