#pragma once

#include "mesh/mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace fettle {

inline constexpr std::size_t kAhead = 32; ///< facets whose corners are asked for before they are needed

/// Three numbers of a corner, none of them -0, which equals +0 but differs in its bits.
template <typename T>
using Corner = std::array<T, 3>;

template <typename T>
bool finite(const Corner<T>& corner)
{
    return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
}

template <typename T>
std::uint64_t hash(const Corner<T>& corner)
{
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    std::uint64_t mixed = 0;
    for (const T coordinate : corner) {
        mixed ^= std::bit_cast<Bits>(coordinate);
        mixed *= 0x9e3779b97f4a7c15; // 2^64 / golden ratio: spreads neighbours (Knuth)
        mixed ^= mixed >> 32;
    }
    return mixed;
}

/// Corners by their coordinates: a hash table with open addressing, filled by several threads at once. Of equal corners
/// the first one stands in it, whoever came first.
class FirstCorners {
  public:
    static constexpr std::uint32_t kFull = ~0u;

    /// @param slots  a power of 2
    explicit FirstCorners(std::size_t slots) : mask_(slots - 1), slots_(new std::atomic<std::uint32_t>[slots])
    {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                slots_[i].store(kEmpty, std::memory_order_relaxed);
        });
    }

    /// Where a corner will be looked for. Nearly every such place is out of the processor's cache, and so is the corner
    /// that stands there: they are asked for some corners ahead.
    void expect(std::uint64_t hash) const { __builtin_prefetch(&slots_[hash & mask_]); }
    /// The corner that stands there now, if any.
    std::optional<std::uint32_t> expected(std::uint64_t hash) const
    {
        const std::uint32_t there = slots_[hash & mask_].load(std::memory_order_relaxed);
        return there == kEmpty ? std::nullopt : std::optional(there);
    }

    /// @return  the slot of a corner; kFull if none was free nearby   @param corner_at  coordinates by number
    template <typename At>
    std::uint32_t add(std::uint32_t corner, std::uint64_t first, const At& corner_at)
    {
        // Of a table that is half full a run this long does not come in the life of the universe.
        constexpr std::size_t kLongestRun = 256;
        const auto here = corner_at(corner);
        for (std::size_t k = 0; k < std::min(kLongestRun, mask_ + 1); ++k) {
            const std::size_t slot = (first + k) & mask_;
            std::uint32_t there = slots_[slot].load(std::memory_order_relaxed);
            if (there == kEmpty && slots_[slot].compare_exchange_strong(there, corner))
                return static_cast<std::uint32_t>(slot);
            if (corner_at(there) != here) continue;
            while (corner < there && !slots_[slot].compare_exchange_weak(there, corner)) {
            }
            return static_cast<std::uint32_t>(slot);
        }
        return kFull;
    }
    std::atomic<std::uint32_t>& operator[](std::uint32_t slot) { return slots_[slot]; }
    /// How many corners stand in it.
    Eigen::Index count() const
    {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, mask_ + 1), Eigen::Index{0},
            [&](const auto& range, Eigen::Index count) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    count += slots_[i].load(std::memory_order_relaxed) != kEmpty;
                return count;
            },
            std::plus<>());
    }

  private:
    static constexpr std::uint32_t kEmpty = ~0u;
    std::size_t mask_;
    std::unique_ptr<std::atomic<std::uint32_t>[]> slots_;
};

inline constexpr std::uint32_t kDropped = ~0u; ///< instead of the slot of a corner

/// Slots of the corners of some facets; kDropped for those of facets with NaN or infinite corners.
/// @return  false if the table is too small
template <typename At>
bool fill(FirstCorners& first, std::size_t begin, std::size_t end, const At& corner_at, std::uint32_t* slots)
{
    std::array<std::uint64_t, 3 * kAhead> hashes;
    const auto corners = [&](const auto& use) {
        for (std::size_t c = 3 * begin; c < 3 * end; ++c) use(static_cast<std::uint32_t>(c), hashes[c - 3 * begin]);
    };
    corners([&](std::uint32_t c, std::uint64_t& hash_of_c) {
        hash_of_c = hash(corner_at(c));
        first.expect(hash_of_c);
    });
    corners([&](std::uint32_t, std::uint64_t hash_of_c) {
        if (const auto there = first.expected(hash_of_c)) corner_at.expect(*there);
    });
    bool room = true;
    corners([&](std::uint32_t c, std::uint64_t hash_of_c) {
        const std::uint32_t facet = c - c % 3;
        const bool whole = finite(corner_at(facet)) && finite(corner_at(facet + 1)) && finite(corner_at(facet + 2));
        slots[c] = whole ? first.add(c, hash_of_c, corner_at) : kDropped;
        room &= !whole || slots[c] != FirstCorners::kFull;
    });
    return room;
}

/// The same of all facets.
template <typename At>
bool fill(FirstCorners& first, std::size_t facets, const At& corner_at, std::uint32_t* slots)
{
    std::atomic<bool> full = false;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, facets), [&](const auto& range) {
        for (std::size_t f = range.begin(); f < range.end() && !full.load(std::memory_order_relaxed); f += kAhead)
            if (!fill(first, f, std::min(f + kAhead, range.end()), corner_at, slots))
                full.store(true, std::memory_order_relaxed);
    });
    return !full.load();
}

/// Facets with equal corners made one vertex; the vertices are numbered as they first appear. Facets with NaN or
/// infinite corners are left out. @param corner_at  the coordinates
/// of a corner by its number, 3 a facet; corner_at.expect(number) fetches them ahead
template <typename At>
Mesh welded(std::size_t facets, const At& corner_at, MeshRepair& repair)
{
    Mesh mesh;
    mesh.triangles.resize(3, static_cast<Eigen::Index>(facets)); // slots of the corners, then their vertices
    const auto slots = reinterpret_cast<std::uint32_t*>(mesh.triangles.data());
    // A closed mesh has half as many vertices as triangles, which fill half of this table; facets that share no
    // vertices need a larger one.
    std::size_t size = std::bit_ceil(facets + 1);
    auto table = std::make_optional<FirstCorners>(size);
    while (!fill(*table, facets, corner_at, slots)) {
        table.reset();
        table.emplace(size *= 4);
    }
    FirstCorners& first = *table;
    // Of equal corners the first is met first: it gets the next number, which then stands in its slot.
    constexpr std::uint32_t kNumbered = 1u << 31;
    mesh.vertices.resize(3, first.count());
    std::uint32_t count = 0;
    std::size_t kept = 0;
    for (std::uint32_t c = 0; c < 3 * facets; ++c) {
        if (slots[c] == kDropped) {
            repair.dropped_triangles += c % 3 == 0;
            continue;
        }
        std::atomic<std::uint32_t>& slot = first[slots[c]];
        if (slot.load(std::memory_order_relaxed) == c) {
            const auto corner = corner_at(c);
            mesh.vertices.col(count) << corner[0], corner[1], corner[2];
            slot.store(kNumbered | count++, std::memory_order_relaxed);
        }
        slots[kept++] = slot.load(std::memory_order_relaxed) & ~kNumbered;
    }
    mesh.triangles.conservativeResize(3, static_cast<Eigen::Index>(kept / 3));
    repair.welded_vertices = static_cast<Eigen::Index>(kept) - count;
    return mesh;
}

} // namespace fettle
