#include "core/morton.h"

#include "core/parallel_box.h"
#include "core/uninitialized_vector.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <compare>
#include <cstdint>

namespace fettle::core {

namespace {

constexpr int kBits = 20; // cells along an axis, as a power of two
constexpr std::uint64_t kAfterAllCells = std::uint64_t{1} << (3 * kBits);

/// Spreads kBits bits so that two zeros follow each.
std::uint64_t spread_bits(std::uint64_t bits)
{
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}

/// A point by its cell's place along the curve.
struct Key {
    std::uint64_t place;
    std::uint32_t point;

    auto operator<=>(const Key&) const = default;
};

} // namespace

std::vector<std::uint32_t> morton_order(const Eigen::Matrix3Xd& points)
{
    const auto count = static_cast<std::size_t>(points.cols());
    const Eigen::AlignedBox3d box = parallel_bounding_box(count, [&](Eigen::AlignedBox3d& some, std::size_t i) {
        if (points.col(i).allFinite()) some.extend(points.col(i));
    });
    const double extent = box.sizes().maxCoeff();
    const double scale = extent > 0 ? ((1 << kBits) - 1) / extent : 0;

    UninitializedVector<Key> keys(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        std::uint64_t place = kAfterAllCells;
        if (points.col(i).allFinite()) {
            const Eigen::Array3i cell = ((points.col(i) - box.min()) * scale).array().cast<int>();
            place = spread_bits(cell.x()) | spread_bits(cell.y()) << 1 | spread_bits(cell.z()) << 2;
        }
        keys[i] = {place, static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(keys);
    std::vector<std::uint32_t> order(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { order[i] = keys[i].point; });
    return order;
}

} // namespace fettle::core
