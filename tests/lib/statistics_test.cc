#include "compare/judgement.h"
#include "geometry/statistics.h"
#include "job/region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace fettle {
namespace statistics_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// By hand.
TEST(Statistics, OfFiveNumbers)
{
    Eigen::VectorXd errors(6), areas(6);
    errors << 3, -1, kNaN, 2, 0, 6;
    areas << 1, 2, 5, 0.5, 1, 1;
    const geometry::Statistics s = geometry::statistics(errors, areas, 2.0);
    EXPECT_EQ(s.count, 5);
    EXPECT_EQ(s.undefined, 1);
    EXPECT_DOUBLE_EQ(s.mean, 2);
    EXPECT_DOUBLE_EQ(s.mean_abs, 2.4);
    EXPECT_DOUBLE_EQ(s.rms, std::sqrt(10));
    EXPECT_DOUBLE_EQ(s.sd, std::sqrt(6));
    EXPECT_EQ(s.min, -1);
    EXPECT_EQ(s.max, 6);
    EXPECT_EQ(s.band, 7);
    EXPECT_EQ(s.p50, 2);
    EXPECT_DOUBLE_EQ(s.p01, -0.96); // 0.04 of the way from the first to the second
    EXPECT_DOUBLE_EQ(s.p95, 5.4);
    EXPECT_DOUBLE_EQ(s.within, 0.6);
    EXPECT_DOUBLE_EQ(s.over_cut_volume, 2);
    EXPECT_DOUBLE_EQ(s.under_cut_volume, 10);
}

// Wang 2007, eq. 4-1: errors of one sign have the largest as band.
TEST(Statistics, BandOfOneSign)
{
    const Eigen::Vector2d areas(1, 1);
    EXPECT_EQ(geometry::statistics(Eigen::Vector2d(1, 3), areas, std::nullopt).band, 3);
    EXPECT_EQ(geometry::statistics(Eigen::Vector2d(-4, -3), areas, std::nullopt).band, 4);
    EXPECT_TRUE(std::isnan(geometry::statistics(Eigen::Vector2d(1, 3), areas, std::nullopt).within));
}

TEST(Statistics, OfNothing)
{
    const geometry::Statistics s = geometry::statistics(Eigen::Vector2d(kNaN, kNaN), Eigen::Vector2d(1, 1), 1.0);
    EXPECT_EQ(s.count, 0);
    EXPECT_EQ(s.undefined, 2);
    EXPECT_TRUE(std::isnan(s.mean));
    EXPECT_EQ(s.over_cut_volume, 0);
    EXPECT_FALSE(compare::judge_conformity(s, 1, 0).within);
}

// Statistics are equal whether the errors are in memory or in a file, in one block or many. Independent reference: a
// sorted list.
TEST(Statistics, OfManyBlocks)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0.1, 2);
    const Eigen::Index count = 100000;
    Eigen::VectorXd errors = Eigen::VectorXd::NullaryExpr(count, [&] { return normal(random); });
    for (Eigen::Index i = 0; i < count; i += 7) errors[i] = std::round(errors[i]); // ties
    errors[11] = 0;
    errors[12] = kNaN;
    Eigen::Matrix3Xd xyz(3, count);
    xyz.setRandom();
    geometry::StatisticsAccumulator whole(1.0), parts(1.0, 12345);
    whole.add(errors, Eigen::VectorXd::Ones(count), xyz);
    for (Eigen::Index first = 0; first < count; first += 1024 * 9) {
        const Eigen::Index some = std::min<Eigen::Index>(1024 * 9, count - first);
        parts.add(errors.segment(first, some), Eigen::VectorXd::Ones(some), xyz.middleCols(first, some));
    }
    const geometry::Statistics s = whole.statistics(), t = parts.statistics();
    std::vector<double> sorted;
    for (const double error : errors)
        if (!std::isnan(error)) sorted.push_back(error);
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
        const double place = share * static_cast<double>(sorted.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
    };
    for (const geometry::Statistics& result : {s, t}) {
        EXPECT_EQ(result.count, count - 1);
        EXPECT_EQ(result.undefined, 1);
        EXPECT_EQ(result.min, sorted.front());
        EXPECT_EQ(result.max, sorted.back());
        EXPECT_DOUBLE_EQ(result.p01, at(0.01));
        EXPECT_DOUBLE_EQ(result.p05, at(0.05));
        EXPECT_DOUBLE_EQ(result.p50, at(0.5));
        EXPECT_DOUBLE_EQ(result.p95, at(0.95));
        EXPECT_DOUBLE_EQ(result.p99, at(0.99));
        EXPECT_NEAR(result.rms * result.rms, result.mean * result.mean + result.sd * result.sd, 1e-13);
        EXPECT_NEAR(result.under_cut_volume - result.over_cut_volume, result.mean * static_cast<double>(count - 1),
                    1e-9);
        EXPECT_DOUBLE_EQ(result.over_cut_area + result.under_cut_area +
                             result.within * static_cast<double>(result.count),
                         static_cast<double>(result.count));
        Eigen::Index min = 0, max = 0;
        errors.array().isNaN().select(0, errors).minCoeff(&min);
        errors.array().isNaN().select(0, errors).maxCoeff(&max);
        EXPECT_EQ(result.min_at, xyz.col(min));
        EXPECT_EQ(result.max_at, xyz.col(max));
    }
    EXPECT_EQ(s.mean, t.mean);
    EXPECT_EQ(s.sd, t.sd);
}

TEST(Statistics, Histogram)
{
    geometry::Histogram histogram(1, 4);
    Eigen::VectorXd errors(9);
    errors << -1.5, -1, -0.5, -0.25, 0, 0.75, 1, 1.25, kNaN;
    histogram.add(errors);
    EXPECT_EQ(histogram.below, 1u);
    EXPECT_EQ(histogram.above, 1u);
    EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{1, 2, 1, 2}));
}

// An error that is over by no more than float coordinates of that size resolve still passes.
TEST(Statistics, AppliesTheToleranceToTheRoundingOfFloats)
{
    const auto judged = [&](double error) {
        return compare::judge_conformity(
            geometry::statistics(Eigen::VectorXd::Constant(1, error), Eigen::VectorXd::Ones(1), 0.5), 0.5, 1000);
    };
    EXPECT_TRUE(judged(-0.5001).within);
    EXPECT_FALSE(judged(-0.501).within);
    EXPECT_EQ(judged(-0.501).max_abs_error, 0.501);
}

// Polygons and points are given in M; a turned W changes nothing.
TEST(Statistics, Regions)
{
    job::Job job;
    job.theta = 0.3;
    job.anomaly.resize(3, 4);
    job.anomaly << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
    job.sampling = 3 * job.anomaly;
    Eigen::Matrix3Xd points(3, 4);
    points << 0.5, 2, 4, kNaN, 0.5, 0, 0, 0, 0, 0, 0, 0;
    const std::vector<job::Region> found = job::classify_regions(job, points);
    EXPECT_EQ(found, (std::vector<job::Region>{job::Region::inside, job::Region::around, job::Region::outside,
                                               job::Region::outside}));
}

} // namespace statistics_test
} // namespace fettle
