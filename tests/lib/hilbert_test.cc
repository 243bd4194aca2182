#include "core/hilbert.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace fettle {
namespace {

// What makes it a Hilbert curve: it visits every cell once, and steps to a neighbour of the last.
TEST(Hilbert, VisitsEveryCellByNeighbours)
{
    for (int bits = 1; bits <= 4; ++bits) {
        const int side = 1 << bits;
        std::vector<Eigen::Array3i> cell(static_cast<std::size_t>(side * side * side), Eigen::Array3i(-1, -1, -1));
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y)
                for (int z = 0; z < side; ++z) cell.at(hilbert({x, y, z}, bits)) << x, y, z;
        EXPECT_EQ(hilbert({0, 0, 0}, bits), 0u);
        for (std::size_t i = 0; i < cell.size(); ++i) {
            ASSERT_GE(cell[i].minCoeff(), 0);
            if (i > 0) {
                ASSERT_EQ((cell[i] - cell[i - 1]).abs().sum(), 1);
            }
        }
    }
}

TEST(Hilbert, OrdersAllPlacesByCurve)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 5000, [&] { return coordinate(random); });
    points.col(7).setConstant(std::numeric_limits<double>::quiet_NaN());
    points(1, 4000) = std::numeric_limits<double>::infinity();
    const auto order = hilbert_order(5000, [&](std::size_t i) -> Eigen::Vector3d { return points.col(i); });
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), 5000u);
    EXPECT_EQ(order[4998], 7u);
    EXPECT_EQ(order[4999], 4000u);
    double way = 0; // from point to point: of the size of their spacing, not of the cube
    for (std::size_t i = 1; i < 4998; ++i) way += (points.col(order[i]) - points.col(order[i - 1])).norm();
    EXPECT_LT(way / 4998, 2 * 2 / std::cbrt(5000));
    EXPECT_TRUE(hilbert_order(0, [](std::size_t) -> Eigen::Vector3d { return {}; }).empty());
}

} // namespace
} // namespace fettle
