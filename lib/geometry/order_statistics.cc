#include "geometry/order_statistics.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace fettle::geometry {

namespace {

constexpr int kKeyBits = 64;
constexpr int kDigitBits = 13; // five passes, in which a thread holds 64 KiB for each prefix
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

// Integers in the same order as the numbers.
std::uint64_t key_of(double number)
{
    const auto bits = std::bit_cast<std::uint64_t>(number);
    return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

double number_of(std::uint64_t key)
{
    return std::bit_cast<double>(key >> 63 ? key & ~(std::uint64_t{1} << 63) : ~key);
}

/// Histogram, over the next digit, of the keys that begin with the same known bits.
struct Prefix {
    std::uint64_t bits = 0;
    std::vector<std::size_t> counts = std::vector<std::size_t>(kDigits, 0);
};

struct ThreadCounts {
    std::vector<double> numbers;
    std::vector<Prefix> prefixes;
};

/// Number of bits in the digit after the known ones: the last is what remains.
int digit_bits(int known) { return std::min(kDigitBits, kKeyBits - known); }

/// Counts the numbers by prefix and next digit. @param known  number of bits in a prefix
void count(const NumberBlocks& numbers, int known, std::vector<Prefix>& prefixes)
{
    const int digit_shift = kKeyBits - known - digit_bits(known);
    const std::size_t digits = std::size_t{1} << digit_bits(known);
    // First digits of the prefixes: few numbers begin with one, so the others are skipped early.
    std::vector<char> first_digits(kDigits, known == 0);
    for (const Prefix& prefix : prefixes)
        if (known > 0) first_digits[prefix.bits >> (known - kDigitBits)] = true;
    tbb::enumerable_thread_specific<ThreadCounts> threads(ThreadCounts{{}, prefixes});
    tbb::parallel_for(std::size_t{0}, numbers.blocks, [&](std::size_t block) {
        ThreadCounts& local = threads.local();
        numbers.read(block, local.numbers);
        for (const double number : local.numbers) {
            const std::uint64_t key = key_of(number);
            if (!first_digits[key >> (kKeyBits - kDigitBits)]) continue;
            const std::uint64_t known_bits = known == 0 ? 0 : key >> (kKeyBits - known);
            for (Prefix& prefix : local.prefixes)
                if (prefix.bits == known_bits) ++prefix.counts[(key >> digit_shift) % digits];
        }
    });
    for (const ThreadCounts& thread : threads)
        for (std::size_t p = 0; p < prefixes.size(); ++p)
            for (std::size_t digit = 0; digit < kDigits; ++digit)
                prefixes[p].counts[digit] += thread.prefixes[p].counts[digit];
}

} // namespace

std::vector<double> order_statistics(const NumberBlocks& numbers, const std::vector<std::size_t>& ranks)
{
    struct Target {
        std::uint64_t bits; ///< known so far
        std::size_t rank;   ///< among the numbers that begin with these bits
    };
    std::vector<Target> targets;
    for (const std::size_t rank : ranks) targets.push_back({0, rank});
    for (int known = 0; known < kKeyBits; known += digit_bits(known)) {
        std::vector<Prefix> prefixes;
        const auto find = [&](const Target& t) { return std::ranges::find(prefixes, t.bits, &Prefix::bits); };
        for (const Target& t : targets)
            if (find(t) == prefixes.end()) prefixes.push_back({t.bits});
        count(numbers, known, prefixes);
        for (Target& t : targets) {
            const Prefix& prefix = *find(t);
            std::size_t digit = 0;
            for (; t.rank >= prefix.counts[digit]; ++digit) t.rank -= prefix.counts[digit];
            t.bits = t.bits << digit_bits(known) | digit;
        }
    }
    std::vector<double> found;
    for (const Target& t : targets) found.push_back(number_of(t.bits));
    return found;
}

} // namespace fettle::geometry
