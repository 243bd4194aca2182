#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace fettle {

/// The cell (x, y, z) of a cube of 2^bits cells a side, as its place along a Hilbert curve: near places are near cells.
/// Hamilton, Compact Hilbert indices, CS-2006-07, Dalhousie University (algorithm 2, n = 3).
/// @param cell  each below 2^bits   @param bits  at most 21
std::uint64_t hilbert(const Eigen::Array3i& cell, int bits);

/// 0 to count - 1 in the order of a Hilbert curve through the box of the places; those in one cell keep their order,
/// those that are not finite come last.
/// @param count  below 2^32   @param place  called from several threads, more than once
std::vector<std::uint32_t> hilbert_order(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& place);

} // namespace fettle
