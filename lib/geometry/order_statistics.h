#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace fettle::geometry {

/// Numbers too many for memory, in blocks that can be read repeatedly.
struct NumberBlocks {
    std::size_t blocks = 0;
    /// Replaces the contents of `into` with the numbers of a block. Called by several threads at once.
    std::function<void(std::size_t block, std::vector<double>& into)> read;
};

/// Order statistics by radix selection: the numbers at `ranks` (0: the smallest) of the sorted sequence. Each of five
/// passes determines 13 more of their bits, so nothing is sorted or held. None of the numbers may be NaN.
/// @param ranks  each below the count of the numbers
std::vector<double> order_statistics(const NumberBlocks& numbers, const std::vector<std::size_t>& ranks);

} // namespace fettle::geometry
