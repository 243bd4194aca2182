#include "compare/statistics.h"

#include "compare/order_statistics.h"
#include "core/constants.h"
#include "job/boundary.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle {

namespace {

constexpr std::size_t kBlock = 1 << 15; // numbers that are taken out of a spool at once

/// The numbers in a spool.
NumberBlocks numbers_in(const Spool& spool)
{
    const std::size_t count = spool.size() / sizeof(double);
    return {(count + kBlock - 1) / kBlock, [&spool, count](std::size_t block, std::vector<double>& into) {
                into.resize(std::min(kBlock, count - block * kBlock));
                spool.read(block * kBlock * sizeof(double), reinterpret_cast<char*>(into.data()),
                           into.size() * sizeof(double));
            }};
}

/// Their squared deviations from the mean, summed: those of each block plainly.
double squared_deviations(const NumberBlocks& numbers, double mean)
{
    std::vector<double> of_block(numbers.blocks, 0);
    tbb::parallel_for(std::size_t{0}, numbers.blocks, [&](std::size_t b) {
        std::vector<double> block;
        numbers.read(b, block);
        for (const double number : block) of_block[b] += (number - mean) * (number - mean);
    });
    Sum sum;
    for (const double part : of_block) sum.add(part);
    return sum.value();
}

void set_percentiles(Statistics& s, const NumberBlocks& numbers)
{
    const std::array shares = {0.01, 0.05, 0.50, 0.95, 0.99};
    const std::array to = {&s.p01, &s.p05, &s.p50, &s.p95, &s.p99};
    const auto last = static_cast<std::size_t>(s.count) - 1;
    std::vector<std::size_t> ranks;
    for (const double share : shares) {
        ranks.push_back(static_cast<std::size_t>(static_cast<double>(last) * share));
        ranks.push_back(std::min(ranks.back() + 1, last));
    }
    const std::vector<double> at = order_statistics(numbers, ranks);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double beyond = static_cast<double>(last) * shares[i] - static_cast<double>(ranks[2 * i]);
        *to[i] = at[2 * i] + beyond * (at[2 * i + 1] - at[2 * i]);
    }
}

} // namespace

Tally::Tally(std::optional<double> tolerance, std::size_t memory) : tolerance_(tolerance), errors_(memory)
{
    so_far_.min = so_far_.max = kNaN;
    so_far_.min_at.setConstant(kNaN);
    so_far_.max_at.setConstant(kNaN);
}

void Tally::add(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, const Eigen::Matrix3Xd& xyz)
{
    constexpr Eigen::Index kShare = 1024; // summed plainly: their roundings stay far below those of the errors
    const double tolerance = tolerance_.value_or(0);
    std::vector<double> defined;
    for (Eigen::Index first = 0; first < errors.size(); first += kShare) {
        double sum = 0, sum_abs = 0, sum_squares = 0, over_area = 0, under_area = 0, over_volume = 0, under_volume = 0;
        defined.clear();
        for (Eigen::Index i = first; i < std::min(first + kShare, errors.size()); ++i) {
            const double error = errors[i];
            if (std::isnan(error)) continue;
            defined.push_back(error);
            sum += error;
            sum_abs += std::abs(error);
            sum_squares += error * error;
            within_ += tolerance_ && std::abs(error) <= *tolerance_;
            const double area = areas[i] > 0 ? areas[i] : 0; // NaN: none
            if (std::abs(error) > tolerance) (error < 0 ? over_area : under_area) += area;
            (error < 0 ? over_volume : under_volume) += std::abs(error) * area;
            if (!(error >= so_far_.min)) so_far_.min = error, so_far_.min_at = xyz.col(i);
            if (!(error <= so_far_.max)) so_far_.max = error, so_far_.max_at = xyz.col(i);
        }
        undefined_ += std::min(kShare, errors.size() - first) - static_cast<Eigen::Index>(defined.size());
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

Statistics Tally::statistics() const
{
    Statistics s = so_far_;
    s.count = static_cast<Eigen::Index>(errors_.size() / sizeof(double));
    s.undefined = undefined_;
    s.mean = s.mean_abs = s.rms = s.sd = s.band = kNaN;
    s.p01 = s.p05 = s.p50 = s.p95 = s.p99 = s.within = kNaN;
    s.over_cut_area = over_cut_area_.value();
    s.under_cut_area = under_cut_area_.value();
    s.over_cut_volume = over_cut_volume_.value();
    s.under_cut_volume = under_cut_volume_.value();
    if (s.count == 0) return s;
    const auto n = static_cast<double>(s.count);
    s.mean = sum_.value() / n;
    s.mean_abs = sum_abs_.value() / n;
    s.rms = std::sqrt(sum_squares_.value() / n);
    s.band = s.min < 0 && s.max > 0 ? s.max - s.min : std::max(std::abs(s.min), std::abs(s.max));
    if (tolerance_) s.within = static_cast<double>(within_) / n;
    const NumberBlocks numbers = numbers_in(errors_);
    s.sd = std::sqrt(squared_deviations(numbers, s.mean) / n);
    set_percentiles(s, numbers);
    return s;
}

double median(const Spool& numbers)
{
    const std::size_t last = numbers.size() / sizeof(double) - 1;
    const std::vector<double> middle = order_statistics(numbers_in(numbers), {last / 2, last - last / 2});
    return (middle[0] + middle[1]) / 2;
}

Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance)
{
    Tally tally(tolerance);
    tally.add(errors, areas, Eigen::Matrix3Xd::Constant(3, errors.size(), kNaN));
    return tally.statistics();
}

void Histogram::add(const Eigen::VectorXd& errors)
{
    const auto bins = static_cast<double>(counts.size());
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

std::vector<Region> regions(const Job& job, const Eigen::Matrix3Xd& xyz)
{
    const Boundaries polygons = boundaries(job);
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(job.theta);
    std::vector<Region> regions(static_cast<std::size_t>(xyz.cols()), Region::outside);
    tbb::parallel_for(Eigen::Index{0}, xyz.cols(), [&](Eigen::Index i) {
        if (!xyz.col(i).allFinite()) return;
        const Eigen::Vector2d point = R_working_machine * xyz.col(i).head<2>();
        Region& region = regions[static_cast<std::size_t>(i)];
        if (contains(polygons.anomaly, point))
            region = Region::inside;
        else if (polygons.sampling.cols() > 0 && contains(polygons.sampling, point))
            region = Region::around;
    });
    return regions;
}

Judgement judge(const Statistics& judged, double tolerance, double largest)
{
    if (judged.count == 0) return {false, kNaN};
    const double rounding = static_cast<double>(std::numeric_limits<float>::epsilon()) * largest; // half of it a file
    const double worst = std::max(std::abs(judged.min), std::abs(judged.max));
    return {worst <= tolerance + rounding, worst};
}

} // namespace fettle
