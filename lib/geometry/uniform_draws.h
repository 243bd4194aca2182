#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

namespace fettle::geometry {

// Random numbers from std::mt19937_64, which is the same everywhere; the distributions of std differ between libraries.

/// Uniform in [0, 1): the upper 53 bits.
inline double draw_uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Uniform in (0, 1), both ends excluded: the upper 53 bits and half a unit.
inline double draw_open_uniform(std::mt19937_64& random)
{
    return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
}

/// Uniform in 0 to count - 1.
inline std::size_t draw_index(std::mt19937_64& random, std::size_t count)
{
    return static_cast<std::size_t>(draw_uniform(random) * static_cast<double>(count));
}

/// Normal with mean 0, from two uniform numbers (Box & Muller, A note on the generation of random normal deviates,
/// 1958).
inline double draw_normal(std::mt19937_64& random, double sigma)
{
    const double u = draw_open_uniform(random), v = draw_open_uniform(random);
    return sigma * std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

} // namespace fettle::geometry
