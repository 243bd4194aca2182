#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace fettle::geometry {

/// Standard deviation of a normal distribution over its median absolute deviation: 1 / Φ⁻¹(3/4), to four digits.
inline constexpr double kMedianToSigma = 1.4826;
/// Φ⁻¹(3/4), the upper quartile of N(0, 1): the reciprocal, to all digits.
inline constexpr double kNormalQuartile = 0.6744897501960817;
/// Cutoff of Tukey's biweight in standard deviations: an efficiency of 95 % for normal noise (Holland & Welsch 1977).
inline constexpr double kTukeyCutoff = 4.685;

// Quantiles of numbers in memory, each found by selection in linear time. The numbers, none of them NaN, are put into
// another order. See order_statistics() for numbers in a file.

/// The number at `rank` (0: the smallest) in ascending order. @param rank  less than the count of the numbers
double nth_smallest(std::span<double> numbers, std::size_t rank);

/// The number at the rank (n - 1) share, rounded down. @param numbers  at least one   @param share  0 to 1
double quantile(std::span<double> numbers, double share);

/// The middle number; the upper one of the two in the middle of an even count. @param numbers  at least one
double median(std::span<double> numbers);

/// Median of |deviation|; 0 if there is none.
double median_absolute(Eigen::VectorXd deviations);

} // namespace fettle::geometry
