#include "geometry/quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::geometry {

namespace {

constexpr std::size_t kMinCount = 64; // fewer are selected as quickly by comparisons, half of which are mispredicted
constexpr std::size_t kIntervals = 128;

/// Equal intervals of the numbers' range, into which they are sorted without comparisons.
class Intervals {
  public:
    explicit Intervals(std::span<const double> numbers)
    {
        const auto all = Eigen::VectorXd::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
        min_ = all.minCoeff();
        scale_ = kIntervals / (all.maxCoeff() - min_);
    }

    /// False if all numbers are the same, or so far apart that their range overflows.
    bool exist() const { return scale_ > 0 && std::isfinite(scale_); }
    std::size_t operator()(double number) const { return static_cast<std::size_t>((number - min_) * scale_); }

  private:
    double min_, scale_;
};

/// Moves the numbers of the interval that holds the rank to the front. @return  them; `rank` becomes that among them
std::span<double> interval_of(std::span<double> numbers, const Intervals& interval, std::size_t& rank)
{
    std::array<std::size_t, kIntervals + 1> counts{}; // the last holds the largest number, but for rounding
    for (const double number : numbers) ++counts[interval(number)];
    std::size_t k = 0;
    for (; rank >= counts[k]; ++k) rank -= counts[k];
    std::size_t moved = 0;
    for (double& number : numbers) {
        const bool is_inside = interval(number) == k;
        std::swap(number, numbers[moved]);
        moved += is_inside;
    }
    return numbers.first(moved);
}

} // namespace

double nth_smallest(std::span<double> numbers, std::size_t rank)
{
    while (numbers.size() >= kMinCount) {
        const Intervals interval(numbers);
        if (!interval.exist()) break;
        const std::size_t before = numbers.size();
        numbers = interval_of(numbers, interval, rank);
        if (2 * numbers.size() > before) break; // some numbers lie far off
    }
    const auto nth = numbers.begin() + rank;
    std::nth_element(numbers.begin(), nth, numbers.end());
    return *nth;
}

double quantile(std::span<double> numbers, double share)
{
    return nth_smallest(numbers, static_cast<std::size_t>(share * (numbers.size() - 1)));
}

double median(std::span<double> numbers) { return nth_smallest(numbers, numbers.size() / 2); }

double median_absolute(Eigen::VectorXd deviations)
{
    if (deviations.size() == 0) return 0;
    deviations = deviations.cwiseAbs();
    return median({deviations.data(), static_cast<std::size_t>(deviations.size())});
}

} // namespace fettle::geometry
