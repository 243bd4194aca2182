#include "geometry/quantiles.h"

#include <algorithm>

namespace fettle::geometry {

double nth_smallest(std::span<double> numbers, std::size_t rank)
{
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
