#include "clean/thinning.h"

#include "core/error.h"
#include "geometry/bounding_box.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <bit>
#include <cstdint>
#include <unordered_map>

namespace fettle::clean {
namespace {

constexpr int kCellBits = 21; // three of them fill a key of 64 bits
constexpr double kMaxCells = 1 << 20;

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

/// The cubes of a grid of edge `length` whose corners lie at its multiples, numbered from below the lowest point.
struct CubeGrid {
    Eigen::Array3d first;
    double length;

    Cell cell_of(const Eigen::Vector3d& point) const
    {
        return ((point.array() / length).floor() - first + 1).matrix().cast<std::int64_t>();
    }
    static std::uint64_t key_of(const Cell& cell)
    {
        return (static_cast<std::uint64_t>(cell.z()) << 2 * kCellBits) |
               (static_cast<std::uint64_t>(cell.y()) << kCellBits) | static_cast<std::uint64_t>(cell.x());
    }
};

CubeGrid cube_grid(const Eigen::Matrix3Xd& xyz, double length)
{
    const Eigen::AlignedBox3d box = geometry::bounding_box(xyz);
    if (box.sizes().maxCoeff() / length > kMaxCells)
        throw core::InputError("the points extend over more than 2^20 times this length");
    return {(box.min().array() / length).floor(), length};
}

struct Entry {
    std::uint64_t key;
    std::uint32_t index;
    auto operator<=>(const Entry&) const = default;
};

std::vector<char> thin_by_voxels(const Eigen::Matrix3Xd& xyz, double length)
{
    const CubeGrid grid = cube_grid(xyz, length);
    std::vector<Entry> entries(xyz.cols());
    tbb::parallel_for(std::size_t{0}, entries.size(), [&](std::size_t i) {
        entries[i] = {CubeGrid::key_of(grid.cell_of(xyz.col(i))), static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(entries);
    std::vector<char> stays(entries.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (end = begin; end < entries.size() && entries[end].key == entries[begin].key; ++end)
            sum += xyz.col(entries[end].index);
        const Eigen::Vector3d mean = sum / static_cast<double>(end - begin);
        std::size_t nearest = begin;
        double min_square = (xyz.col(entries[begin].index) - mean).squaredNorm();
        for (std::size_t k = begin + 1; k < end; ++k)
            if (const double square = (xyz.col(entries[k].index) - mean).squaredNorm(); square < min_square) {
                min_square = square;
                nearest = k;
            }
        stays[entries[nearest].index] = 1;
    }
    return stays;
}

std::vector<char> thin_by_spacing(const Eigen::Matrix3Xd& xyz, double length)
{
    const CubeGrid grid = cube_grid(xyz, length);
    std::unordered_map<std::uint64_t, std::vector<Eigen::Index>> kept; // by cube: nearer ones lie in the 27 around
    const auto is_near_a_kept_one = [&](const Eigen::Vector3d& point) {
        const Cell cell = grid.cell_of(point);
        for (int n = 0; n < 27; ++n) {
            const auto found = kept.find(CubeGrid::key_of(cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
            if (found == kept.end()) continue;
            for (const Eigen::Index other : found->second)
                if ((xyz.col(other) - point).norm() < length) return true;
        }
        return false;
    };
    std::vector<char> stays(xyz.cols(), 0);
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        if (is_near_a_kept_one(xyz.col(i))) continue;
        stays[i] = 1;
        kept[CubeGrid::key_of(grid.cell_of(xyz.col(i)))].push_back(i);
    }
    return stays;
}

/// Hash of three coordinates; 0 and -0 have the same.
std::uint64_t hash_of(const Eigen::Vector3d& point)
{
    std::uint64_t hash = 0;
    for (const double x : point) { // the finalizer of SplitMix64 (Steele, Lea & Flood 2014) for each
        hash += std::bit_cast<std::uint64_t>(x + 0.0) + 0x9e3779b97f4a7c15;
        hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9;
        hash = (hash ^ (hash >> 27)) * 0x94d049bb133111eb;
        hash ^= hash >> 31;
    }
    return hash;
}

} // namespace

std::vector<char> thin(const Eigen::Matrix3Xd& xyz, const Thinning& thinning)
{
    if (xyz.cols() == 0) return {};
    return thinning.rule == Thinning::Rule::voxel ? thin_by_voxels(xyz, thinning.length)
                                                  : thin_by_spacing(xyz, thinning.length);
}

std::vector<char> find_duplicates(const Eigen::Matrix3Xd& xyz)
{
    constexpr std::uint32_t kEmpty = UINT32_MAX;
    const std::size_t size = std::bit_ceil(2 * static_cast<std::size_t>(xyz.cols()) + 1);
    std::vector<std::uint32_t> slots(size, kEmpty); // open addressing, at most half full
    std::vector<char> is_duplicate(xyz.cols(), 0);
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        std::size_t slot = hash_of(xyz.col(i)) & (size - 1);
        while (slots[slot] != kEmpty && xyz.col(slots[slot]) != xyz.col(i)) slot = (slot + 1) & (size - 1);
        if (slots[slot] == kEmpty)
            slots[slot] = static_cast<std::uint32_t>(i);
        else
            is_duplicate[i] = 1;
    }
    return is_duplicate;
}

} // namespace fettle::clean
