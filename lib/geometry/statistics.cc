#include "geometry/statistics.h"

#include "core/constants.h"
#include "geometry/order_statistics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::geometry {

namespace {

constexpr std::size_t kBlockNumbers = 1 << 15; // numbers read from a spool at once

NumberBlocks blocks_of(const core::Spool& spool)
{
    const std::size_t count = spool.size() / sizeof(double);
    return {(count + kBlockNumbers - 1) / kBlockNumbers, [&spool, count](std::size_t block, std::vector<double>& into) {
                into.resize(std::min(kBlockNumbers, count - block * kBlockNumbers));
                spool.read(block * kBlockNumbers * sizeof(double), reinterpret_cast<char*>(into.data()),
                           into.size() * sizeof(double));
            }};
}

/// Σ (x - mean)²: plain sums within blocks, a compensated sum over blocks.
double sum_squared_deviations(const NumberBlocks& numbers, double mean)
{
    std::vector<double> block_sums(numbers.blocks, 0);
    tbb::parallel_for(std::size_t{0}, numbers.blocks, [&](std::size_t b) {
        std::vector<double> block;
        numbers.read(b, block);
        for (const double number : block) block_sums[b] += (number - mean) * (number - mean);
    });
    CompensatedSum sum;
    for (const double block_sum : block_sums) sum.add(block_sum);
    return sum.value();
}

void set_percentiles(Statistics& s, const NumberBlocks& numbers)
{
    const std::array fractions = {0.01, 0.05, 0.50, 0.95, 0.99};
    const std::array results = {&s.p01, &s.p05, &s.p50, &s.p95, &s.p99};
    const std::size_t last = s.count - 1;
    std::vector<std::size_t> ranks;
    for (const double fraction : fractions) {
        ranks.push_back(static_cast<std::size_t>(last * fraction));
        ranks.push_back(std::min(ranks.back() + 1, last));
    }
    const std::vector<double> values = order_statistics(numbers, ranks);
    for (std::size_t i = 0; i < fractions.size(); ++i) {
        const double remainder = last * fractions[i] - ranks[2 * i];
        *results[i] = values[2 * i] + remainder * (values[2 * i + 1] - values[2 * i]);
    }
}

} // namespace

StatisticsAccumulator::StatisticsAccumulator(std::optional<double> tolerance, std::size_t memory)
    : tolerance_(tolerance), errors_(memory)
{
    extremes_.min = extremes_.max = core::kNaN;
    extremes_.min_at.setConstant(core::kNaN);
    extremes_.max_at.setConstant(core::kNaN);
}

void StatisticsAccumulator::add(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas,
                                const Eigen::Matrix3Xd& xyz)
{
    constexpr Eigen::Index kErrorsPerSum =
        1024; // errors in a plain sum: its rounding stays far below that of the errors
    const double tolerance = tolerance_.value_or(0);
    std::vector<double> defined;
    for (Eigen::Index first = 0; first < errors.size(); first += kErrorsPerSum) {
        double sum = 0, sum_abs = 0, sum_squares = 0, over_area = 0, under_area = 0, over_volume = 0, under_volume = 0;
        defined.clear();
        for (Eigen::Index i = first; i < std::min(first + kErrorsPerSum, errors.size()); ++i) {
            const double error = errors[i];
            if (std::isnan(error)) continue;
            defined.push_back(error);
            sum += error;
            sum_abs += std::abs(error);
            sum_squares += error * error;
            within_ += tolerance_ && std::abs(error) <= *tolerance_;
            const double area = areas[i] > 0 ? areas[i] : 0; // also for NaN
            if (std::abs(error) > tolerance) (error < 0 ? over_area : under_area) += area;
            (error < 0 ? over_volume : under_volume) += std::abs(error) * area;
            if (!(error >= extremes_.min)) extremes_.min = error, extremes_.min_at = xyz.col(i);
            if (!(error <= extremes_.max)) extremes_.max = error, extremes_.max_at = xyz.col(i);
        }
        undefined_ += std::min(kErrorsPerSum, errors.size() - first) - static_cast<Eigen::Index>(defined.size());
        sum_.add(sum);
        sum_abs_.add(sum_abs);
        sum_squares_.add(sum_squares);
        over_cut_area_.add(over_area);
        under_cut_area_.add(under_area);
        over_cut_volume_.add(over_volume);
        under_cut_volume_.add(under_volume);
        errors_.append({reinterpret_cast<const char*>(defined.data()), defined.size() * sizeof(double)});
    }
}

Statistics StatisticsAccumulator::statistics() const
{
    Statistics s = extremes_;
    s.count = errors_.size() / sizeof(double);
    s.undefined = undefined_;
    s.mean = s.mean_abs = s.rms = s.sd = s.band = core::kNaN;
    s.p01 = s.p05 = s.p50 = s.p95 = s.p99 = s.within = core::kNaN;
    s.over_cut_area = over_cut_area_.value();
    s.under_cut_area = under_cut_area_.value();
    s.over_cut_volume = over_cut_volume_.value();
    s.under_cut_volume = under_cut_volume_.value();
    if (s.count == 0) return s;
    const double n = s.count;
    s.mean = sum_.value() / n;
    s.mean_abs = sum_abs_.value() / n;
    s.rms = std::sqrt(sum_squares_.value() / n);
    s.band = s.min < 0 && s.max > 0 ? s.max - s.min : std::max(std::abs(s.min), std::abs(s.max));
    if (tolerance_) s.within = within_ / n;
    const NumberBlocks numbers = blocks_of(errors_);
    s.sd = std::sqrt(sum_squared_deviations(numbers, s.mean) / n);
    set_percentiles(s, numbers);
    return s;
}

double median(const core::Spool& numbers)
{
    const std::size_t last = numbers.size() / sizeof(double) - 1;
    const std::vector<double> middle = order_statistics(blocks_of(numbers), {last / 2, last - last / 2});
    return (middle[0] + middle[1]) / 2;
}

Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance)
{
    StatisticsAccumulator accumulator(tolerance);
    accumulator.add(errors, areas, Eigen::Matrix3Xd::Constant(3, errors.size(), core::kNaN));
    return accumulator.statistics();
}

void Histogram::add(const Eigen::VectorXd& errors)
{
    const double bins = counts.size();
    for (const double error : errors) {
        if (std::isnan(error)) continue;
        if (error < -limit)
            ++below;
        else if (error > limit)
            ++above;
        else
            ++counts[static_cast<std::size_t>(std::min((error / limit + 1) / 2 * bins, bins - 1))];
    }
}

} // namespace fettle::geometry
