#include "cloud/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace fettle {
namespace {

std::vector<Eigen::Index> by_brute_force(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& query,
                                         std::size_t count)
{
    std::vector<std::pair<double, Eigen::Index>> all;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) all.emplace_back((points.col(i) - query).squaredNorm(), i);
    std::sort(all.begin(), all.end());
    std::vector<Eigen::Index> columns;
    for (std::size_t i = 0; i < std::min(count, all.size()); ++i) columns.push_back(all[i].second);
    return columns;
}

TEST(Neighbours, AgreeWithBruteForce)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1e3, 1e3);
    const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 1000, [&] { return place(random); });
    const Neighbours neighbours(points);
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d query = Eigen::Vector3d::NullaryExpr([&] { return 1.5 * place(random); });
        EXPECT_EQ(neighbours.nearest(query, 17), by_brute_force(points, query, 17));
    }
}

// On a lattice most distances are ties; a NaN point is none.
TEST(Neighbours, BreaksTiesByColumn)
{
    Eigen::Matrix3Xd points(3, 1000);
    for (int i = 0; i < 1000; ++i) points.col(i) << i % 10, i / 10 % 10, i / 100;
    points(1, 555) = std::numeric_limits<double>::quiet_NaN();
    const Neighbours neighbours(points);
    EXPECT_EQ(neighbours.size(), 999);
    for (const Eigen::Vector3d& query :
         {Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(4.5, 4.5, 0), Eigen::Vector3d(-3, 0, 0)})
        EXPECT_EQ(neighbours.nearest(query, 24), by_brute_force(points, query, 24));
}

TEST(Neighbours, FewPoints)
{
    EXPECT_TRUE(Neighbours(Eigen::Matrix3Xd(3, 0)).nearest({0, 0, 0}, 5).empty());
    EXPECT_EQ(Neighbours(Eigen::Matrix3Xd::Zero(3, 3)).nearest({1, 0, 0}, 5), (std::vector<Eigen::Index>{0, 1, 2}));
}

} // namespace
} // namespace fettle
