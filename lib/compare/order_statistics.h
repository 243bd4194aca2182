#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace fettle {

/// Numbers too many to hold, that may be read as often as wanted.
struct NumberBlocks {
    std::size_t blocks = 0;
    /// Puts the numbers of a block into a vector. Called by several threads at once.
    std::function<void(std::size_t block, std::vector<double>& into)> read;
};

/// The numbers that would stand at `ranks` (0: the smallest) if they were sorted, found in four passes that each tell
/// 16 bits more of them (radix selection). None of the numbers is NaN.
/// @param ranks  below their count
std::vector<double> order_statistics(const NumberBlocks& numbers, const std::vector<std::size_t>& ranks);

} // namespace fettle
