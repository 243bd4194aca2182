#include "core/morton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace fettle {
namespace morton_test {

// The curve visits all cells of an octant before those of the next: x alternates fastest, z slowest.
TEST(Morton, GoesThroughOctantsInTurn)
{
    Eigen::Matrix3Xd corners(3, 64);
    std::vector<std::uint32_t> along_curve;
    for (int i = 0; i < 64; ++i) {
        corners.col(i) << (i & 1) + (i >> 2 & 2), (i >> 1 & 1) + (i >> 3 & 2), (i >> 2 & 1) + (i >> 4 & 2);
        along_curve.push_back(static_cast<std::uint32_t>(i));
    }
    EXPECT_EQ(core::morton_order(corners), along_curve);
    EXPECT_EQ(core::morton_order(corners.rowwise().reverse()).front(), 63u);
}

TEST(Morton, OrdersAllPlacesByCurve)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 5000, [&] { return coordinate(random); });
    points.col(7).setConstant(std::numeric_limits<double>::quiet_NaN());
    points(1, 4000) = std::numeric_limits<double>::infinity();
    const auto order = core::morton_order(points);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), 5000u);
    EXPECT_EQ(order[4998], 7u);
    EXPECT_EQ(order[4999], 4000u);
    double length = 0; // from point to point: of the size of their spacing, not of the cube
    for (std::size_t i = 1; i < 4998; ++i) length += (points.col(order[i]) - points.col(order[i - 1])).norm();
    EXPECT_LT(length / 4998, 2 * 2 / std::cbrt(5000));
    EXPECT_TRUE(core::morton_order(Eigen::Matrix3Xd(3, 0)).empty());
}

} // namespace morton_test
} // namespace fettle
