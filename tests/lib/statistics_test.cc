#include "compare/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fettle {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// By hand.
TEST(Statistics, OfFiveNumbers)
{
    Eigen::VectorXd errors(6), areas(6);
    errors << 3, -1, kNaN, 2, 0, 6;
    areas << 1, 2, 5, 0.5, 1, 1;
    const Statistics s = statistics(errors, areas, 2.0);
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
    EXPECT_EQ(statistics(Eigen::Vector2d(1, 3), areas, std::nullopt).band, 3);
    EXPECT_EQ(statistics(Eigen::Vector2d(-4, -3), areas, std::nullopt).band, 4);
    EXPECT_TRUE(std::isnan(statistics(Eigen::Vector2d(1, 3), areas, std::nullopt).within));
}

TEST(Statistics, OfNothing)
{
    const Statistics s = statistics(Eigen::Vector2d(kNaN, kNaN), Eigen::Vector2d(1, 1), 1.0);
    EXPECT_EQ(s.count, 0);
    EXPECT_EQ(s.undefined, 2);
    EXPECT_TRUE(std::isnan(s.mean));
    EXPECT_EQ(s.over_cut_volume, 0);
    EXPECT_FALSE(judge(s, 1, Eigen::Matrix3Xd::Zero(3, 2)).within);
}

// An error that is over by no more than float coordinates of that size resolve still passes.
TEST(Statistics, JudgesToTheRoundingOfFloats)
{
    const Eigen::Matrix3Xd far = Eigen::Matrix3Xd::Constant(3, 1, 1000);
    const auto judged = [&](double error) {
        return judge(statistics(Eigen::VectorXd::Constant(1, error), Eigen::VectorXd::Ones(1), 0.5), 0.5, far);
    };
    EXPECT_TRUE(judged(-0.5001).within);
    EXPECT_FALSE(judged(-0.501).within);
    EXPECT_EQ(judged(-0.501).worst, 0.501);
}

// Polygons and points are given in M; a turned W changes nothing.
TEST(Statistics, Regions)
{
    Job job;
    job.theta = 0.3;
    job.anomaly.resize(3, 4);
    job.anomaly << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
    job.sampling = 3 * job.anomaly;
    Eigen::Matrix3Xd points(3, 4);
    points << 0.5, 2, 4, kNaN, 0.5, 0, 0, 0, 0, 0, 0, 0;
    const std::vector<Region> found = regions(job, points);
    EXPECT_EQ(found, (std::vector<Region>{Region::inside, Region::around, Region::outside, Region::outside}));
    const Eigen::Vector4d errors(1, 2, 3, kNaN);
    const Statistics outside = statistics(errors, Eigen::Vector4d::Ones(), std::nullopt, found, Region::outside);
    EXPECT_EQ(outside.count, 1);
    EXPECT_EQ(outside.undefined, 1);
    EXPECT_EQ(outside.mean, 3);
}

} // namespace
} // namespace fettle
