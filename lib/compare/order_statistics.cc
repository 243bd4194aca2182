#include "compare/order_statistics.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace fettle {

namespace {

constexpr int kDigitBits = 16;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

// Bits that are ordered as the numbers are.
std::uint64_t key_of(double number)
{
    const auto bits = std::bit_cast<std::uint64_t>(number);
    return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

double number_of(std::uint64_t key)
{
    return std::bit_cast<double>(key >> 63 ? key & ~(std::uint64_t{1} << 63) : ~key);
}

/// Numbers that begin with the same known bits, some ranks among them.
struct Prefix {
    std::uint64_t bits = 0;
    std::vector<std::size_t> counts = std::vector<std::size_t>(kDigits, 0); ///< by the next digit
};

/// What a thread needs to count.
struct Room {
    std::vector<double> numbers;
    std::vector<Prefix> prefixes;
};

/// Counts the numbers by prefix and next digit. @param known  bits of the prefixes
void count(const NumberBlocks& numbers, int known, std::vector<Prefix>& prefixes)
{
    std::vector<char> first_digits(kDigits, known == 0); // with which a prefix begins: few numbers do
    for (const Prefix& prefix : prefixes)
        if (known > 0) first_digits[prefix.bits >> (known - kDigitBits)] = true;
    tbb::enumerable_thread_specific<Room> rooms(Room{{}, prefixes});
    tbb::parallel_for(std::size_t{0}, numbers.blocks, [&](std::size_t block) {
        Room& room = rooms.local();
        numbers.read(block, room.numbers);
        for (const double number : room.numbers) {
            const std::uint64_t key = key_of(number);
            if (!first_digits[key >> (64 - kDigitBits)]) continue;
            const std::uint64_t begin = known == 0 ? 0 : key >> (64 - known);
            for (Prefix& prefix : room.prefixes)
                if (prefix.bits == begin) ++prefix.counts[(key >> (64 - kDigitBits - known)) % kDigits];
        }
    });
    for (const Room& room : rooms)
        for (std::size_t p = 0; p < prefixes.size(); ++p)
            for (std::size_t digit = 0; digit < kDigits; ++digit)
                prefixes[p].counts[digit] += room.prefixes[p].counts[digit];
}

} // namespace

std::vector<double> order_statistics(const NumberBlocks& numbers, const std::vector<std::size_t>& ranks)
{
    struct Wanted {
        std::uint64_t bits;
        std::size_t rank; ///< among the numbers that begin with these bits
    };
    std::vector<Wanted> wanted;
    for (const std::size_t rank : ranks) wanted.push_back({0, rank});
    for (int known = 0; known < 64; known += kDigitBits) {
        std::vector<Prefix> prefixes;
        for (const Wanted& w : wanted) {
            const auto same = [&](const Prefix& prefix) { return prefix.bits == w.bits; };
            if (std::none_of(prefixes.begin(), prefixes.end(), same)) prefixes.push_back({w.bits});
        }
        count(numbers, known, prefixes);
        for (Wanted& w : wanted) {
            const auto at = std::find_if(prefixes.begin(), prefixes.end(),
                                         [&](const Prefix& prefix) { return prefix.bits == w.bits; });
            std::size_t digit = 0;
            for (; w.rank >= at->counts[digit]; ++digit) w.rank -= at->counts[digit];
            w.bits = w.bits << kDigitBits | digit;
        }
    }
    std::vector<double> found;
    for (const Wanted& w : wanted) found.push_back(number_of(w.bits));
    return found;
}

} // namespace fettle
