#include "core/hilbert.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace fettle {

namespace {

// Hamilton's entry point e and direction d make a state; of 8 · 3 of them each octant leads to a place and a next one.
struct Step {
    std::uint8_t place = 0;
    std::uint8_t next = 0;
};
using Table = std::array<std::array<Step, 8>, 24>;

constexpr unsigned rotated_right(unsigned bits, unsigned by) { return ((bits >> by) | (bits << (3 - by))) & 7; }
constexpr unsigned rotated_left(unsigned bits, unsigned by) { return rotated_right(bits, (3 - by) % 3); }
constexpr unsigned gray(unsigned i) { return i ^ (i >> 1); }

constexpr Table make_table()
{
    std::array<unsigned, 8> gray_inverse{};
    for (unsigned i = 0; i < 8; ++i) gray_inverse[gray(i)] = i;
    const auto trailing_ones = [](unsigned i) { return static_cast<unsigned>(std::countr_one(i)); };
    Table table{};
    for (unsigned e = 0; e < 8; ++e)
        for (unsigned d = 0; d < 3; ++d)
            for (unsigned octant = 0; octant < 8; ++octant) {
                const unsigned w = gray_inverse[rotated_right(octant ^ e, (d + 1) % 3)];
                const unsigned entry = w == 0 ? 0 : gray(2 * ((w - 1) / 2));
                const unsigned along = w == 0 ? 0 : trailing_ones(w % 2 == 0 ? w - 1 : w) % 3;
                const unsigned next = 3 * (e ^ rotated_left(entry, (d + 1) % 3)) + (d + along + 1) % 3;
                table[3 * e + d][octant] = {static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(next)};
            }
    return table;
}

constexpr Table kTable = make_table();

constexpr int kMostBits = 20; // a side: three of them leave a bit for places that are not finite

constexpr int kRadixBits = 11;

// By their bits from `first` on, least significant digit first: stable.
void radix_sort(std::vector<std::uint64_t>& keys, int first)
{
    std::vector<std::uint64_t> other(keys.size());
    constexpr std::uint64_t kMask = (1 << kRadixBits) - 1;
    for (int shift = first; shift < 64; shift += kRadixBits) {
        std::array<std::size_t, kMask + 2> place{};
        for (const std::uint64_t key : keys) ++place[((key >> shift) & kMask) + 1];
        if (std::find(place.begin(), place.end(), keys.size()) != place.end()) continue; // all alike
        for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
        for (const std::uint64_t key : keys) other[place[(key >> shift) & kMask]++] = key;
        keys.swap(other);
    }
}

struct Box {
    Eigen::Array3d least = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array3d most = -least;
};

Box box_of(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& place)
{
    const auto of_range = [&](const tbb::blocked_range<std::size_t>& range, Box box) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            if (const Eigen::Array3d p = place(i); p.allFinite()) box = {box.least.min(p), box.most.max(p)};
        return box;
    };
    const auto join = [](const Box& a, const Box& b) { return Box{a.least.min(b.least), a.most.max(b.most)}; };
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count), Box{}, of_range, join);
}

} // namespace

std::uint64_t hilbert(const Eigen::Array3i& cell, int bits)
{
    std::uint64_t place = 0;
    unsigned state = 0;
    for (int bit = bits - 1; bit >= 0; --bit) {
        const unsigned octant = (static_cast<unsigned>(cell.x()) >> bit & 1) |
                                (static_cast<unsigned>(cell.y()) >> bit & 1) << 1 |
                                (static_cast<unsigned>(cell.z()) >> bit & 1) << 2;
        const Step step = kTable[state][octant];
        place = place << 3 | step.place;
        state = step.next;
    }
    return place;
}

std::vector<std::uint32_t> hilbert_order(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& place)
{
    const Box box = box_of(count, place);
    // A place and its number share 64 bits: the more there are, the fewer bits for the place, which still tells more
    // cells than there are numbers.
    const int number_bits = std::bit_width(count);
    const int bits = std::min((63 - number_bits) / 3, kMostBits);
    const double cells = static_cast<double>(1 << bits) * (1 - 1e-9); // the greatest coordinate in the last cell
    const double extent = (box.most - box.least).maxCoeff();
    const double scale = extent > 0 ? cells / extent : 0;

    std::vector<std::uint64_t> keys(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Eigen::Array3d p = place(i);
        const std::uint64_t key =
            p.allFinite() ? hilbert(((p - box.least) * scale).cast<int>(), bits) : std::uint64_t{1} << (3 * bits);
        keys[i] = key << number_bits | i;
    });
    radix_sort(keys, number_bits);
    std::vector<std::uint32_t> order(count);
    const std::uint64_t numbers = (std::uint64_t{1} << number_bits) - 1;
    for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(keys[i] & numbers);
    return order;
}

} // namespace fettle
