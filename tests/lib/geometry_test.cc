#include "core/error.h"
#include "geometry/bounding_box.h"
#include "geometry/clipping.h"
#include "geometry/division.h"
#include "geometry/quantiles.h"
#include "geometry/stray_point.h"
#include "geometry/uniform_draws.h"
#include "geometry/union_find.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {

namespace geometry_test {

// Against sorting.
TEST(Quantiles, AreOrderStatistics)
{
    std::mt19937_64 random(1);
    for (const std::size_t count : {1u, 2u, 7u, 100u}) {
        std::vector<double> numbers(count);
        for (double& number : numbers) number = geometry::draw_uniform(random);
        std::vector<double> sorted = numbers;
        std::ranges::sort(sorted);
        for (std::size_t rank = 0; rank < count; ++rank) EXPECT_EQ(geometry::nth_smallest(numbers, rank), sorted[rank]);
        EXPECT_EQ(geometry::median(numbers), sorted[count / 2]);
        EXPECT_EQ(geometry::quantile(numbers, 0), sorted.front());
        EXPECT_EQ(geometry::quantile(numbers, 1), sorted.back());
        EXPECT_EQ(geometry::quantile(numbers, 0.3), sorted[static_cast<std::size_t>(0.3 * (count - 1.0))]);
    }
    // Many, of which some are the same, some far off, and one is infinite.
    for (const double share : {0.0, 0.01, 0.5, 0.9}) {
        std::vector<double> numbers(5000);
        for (double& number : numbers) {
            number = std::floor(1000 * geometry::draw_normal(random, 1)) / 1000;
            if (geometry::draw_uniform(random) < share) number *= 1e6;
        }
        for (const double last : {1.0, std::numeric_limits<double>::infinity()}) {
            numbers.back() = last;
            std::vector<double> sorted = numbers;
            std::ranges::sort(sorted);
            for (const std::size_t rank : {0u, 1u, 700u, 2500u, 4900u, 4999u}) {
                std::vector<double> some = numbers;
                EXPECT_EQ(geometry::nth_smallest(some, rank), sorted[rank]);
                std::ranges::sort(some);
                EXPECT_EQ(some, sorted);
            }
        }
    }
    std::vector<double> same(100, 0.1);
    EXPECT_EQ(geometry::median(same), 0.1);
    EXPECT_EQ(geometry::median_absolute(Eigen::Vector4d(-5, 1, -2, 3)), 3);
    EXPECT_EQ(geometry::median_absolute(Eigen::VectorXd()), 0);
}

// The constants against draws: 1e5 of them determine a median to 0.4 %.
TEST(Quantiles, ConstantsAreThoseOfTheNormalDistribution)
{
    std::mt19937_64 random(1);
    Eigen::VectorXd draws(100000);
    for (double& draw : draws) draw = geometry::draw_normal(random, 2);
    EXPECT_NEAR(geometry::kMedianToSigma * geometry::median_absolute(draws), 2, 0.03);
    EXPECT_NEAR(std::sqrt(draws.squaredNorm() / draws.size()), 2, 0.02);
    EXPECT_NEAR(geometry::kMedianToSigma * geometry::kNormalQuartile, 1, 1e-5);
}

TEST(UniformDraws, AreTheSameOnEveryComputer)
{
    std::mt19937_64 random(5489); // the 10000th number of this seed is in the standard: [rand.predef]
    random.discard(9999);
    EXPECT_EQ(geometry::draw_uniform(random), double(9981545732273789042u >> 11) * 0x1p-53);
    for (int i = 0; i < 1000; ++i) EXPECT_LT(geometry::draw_index(random, 3), 3u);
}

TEST(UnionFind, RootIsTheLowestElement)
{
    geometry::UnionFind sets(6);
    sets.join(4, 5);
    sets.join(2, 3);
    sets.join(5, 3);
    for (const std::uint32_t element : {2u, 3u, 4u, 5u}) EXPECT_EQ(sets.root(element), 2u);
    EXPECT_EQ(sets.root(0), 0u);
    sets.join_under(2, 1);
    EXPECT_EQ(sets.root(5), 1u);
    sets.join_under(0, 4); // under the root of 4
    EXPECT_EQ(sets.root(0), 1u);
}

// A ring of odd steps: the parity is that of the distance from element 0.
TEST(UnionFind, ParityAddsUpAlongTheWay)
{
    geometry::UnionFind sets(100);
    for (std::uint32_t i = 99; i > 0; --i) sets.join(i, i - 1, true);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(sets.find(i).element, 0u);
        EXPECT_EQ(sets.find(i).odd, i % 2 == 1);
    }
    sets.join(0, 2, true); // contradicts the ring, and is ignored
    EXPECT_FALSE(sets.find(2).odd);
}

// The areas in the cells of a lattice add up to that of the triangle, and each part lies in the plane and in its cell.
TEST(Clipping, PartsAddUpToTheTriangle)
{
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 100; ++trial) {
        Eigen::Matrix3d triangle;
        for (double& coordinate : triangle.reshaped()) coordinate = 4 * geometry::draw_uniform(random);
        const Eigen::Vector3d a = triangle.col(0), normal = (triangle.col(1) - a).cross(triangle.col(2) - a);
        double area = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const Eigen::AlignedBox2d cell(Eigen::Vector2d(i, j), Eigen::Vector2d(i + 1, j + 1));
                const geometry::ClippedTriangle<2> flat(triangle.topRows<2>(), cell);
                area += geometry::polygon_area(flat.corners());
                const geometry::ClippedTriangle<3> part(triangle, cell);
                for (const Eigen::Vector3d& p : part.corners()) {
                    EXPECT_NEAR(normal.dot(p - a), 0, 1e-12);
                    EXPECT_LT(cell.exteriorDistance(Eigen::Vector2d(p.head<2>())), 1e-12);
                }
            }
        EXPECT_NEAR(area, std::abs(normal.z()) / 2, 1e-12);
    }
}

TEST(Clipping, ToleranceEnlargesTheRectangle)
{
    const Eigen::AlignedBox2d cell(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
    Eigen::Matrix<double, 2, 3> beside;
    beside << 1.05, 2, 2, 0, 0, 1;
    const geometry::ClippedTriangle<2> outside(beside, cell), inside(beside, cell, 0.1);
    EXPECT_TRUE(outside.corners().empty());
    EXPECT_FALSE(inside.corners().empty());
}

// A ring of radius 10, one point of which is moved away.
TEST(StrayPoint, IsAThousandTimesAsFarAsHalf)
{
    Eigen::Matrix3Xd points(3, 5000);
    for (int i = 0; i < 5000; ++i) points.col(i) << 100 + 10 * std::cos(i), 200 + 10 * std::sin(i), 5;
    EXPECT_FALSE(geometry::find_stray_point(points));
    EXPECT_LT((geometry::sampled_median(points) - Eigen::Vector3d(100, 200, 5)).norm(), 1);
    points.col(7).setConstant(std::nan(""));
    points.col(4321) << 100, 200, 5 + 9000;
    EXPECT_FALSE(geometry::find_stray_point(points));
    points.col(4321) << 100, 200, 5 - 12000;
    const auto stray = geometry::find_stray_point(points);
    ASSERT_TRUE(stray);
    EXPECT_EQ(stray->index, 4321);
    EXPECT_NEAR(stray->ratio, 1200, 100);
    EXPECT_FALSE(geometry::find_stray_point(Eigen::Matrix3Xd(3, 0)));
    EXPECT_FALSE(geometry::find_stray_point(Eigen::Matrix3Xd::Constant(3, 9, std::nan(""))));
    EXPECT_FALSE(geometry::find_stray_point(Eigen::Matrix3Xd::Constant(3, 9, 4)));
}

// A side of 3, 4, 5 has coordinates that are exact.
TEST(Division, PiecesAreEqualAndNoLonger)
{
    const Eigen::Vector2d from(1, 2), to(7, 10); // length 10
    Eigen::Matrix2Xd quarters(2, 3);
    quarters << 2.5, 4, 5.5, 4, 6, 8;
    EXPECT_EQ(geometry::division_points(from, to, 2.5), quarters);
    EXPECT_EQ(geometry::division_points(from, to, 3.3), quarters);
    EXPECT_EQ(geometry::division_points(to, from, 2.5), quarters.rowwise().reverse());
    EXPECT_EQ(geometry::division_points(from, to, 2.4).cols(), 4);
    EXPECT_EQ(geometry::division_points(from, to, 10).cols(), 0);
    EXPECT_EQ(geometry::division_points(from, from, 1).cols(), 0);
    for (const double length : {0.0, -1.0, std::nan("")})
        EXPECT_THROW(geometry::division_points(from, to, length), core::InputError);
}

TEST(BoundingBox, OfPoints)
{
    Eigen::Matrix3Xd points(3, 3);
    points << 1, 3, NAN, 2, 1, 7, 5, 3, 0;
    EXPECT_EQ(geometry::finite_bounding_box(points).min(), Eigen::Vector3d(1, 1, 3));
    EXPECT_EQ(geometry::finite_bounding_box(points).max(), Eigen::Vector3d(3, 2, 5));
    EXPECT_EQ(geometry::bounding_box(points.bottomRows<2>()).max(), Eigen::Vector2d(7, 5));
    EXPECT_TRUE(geometry::finite_bounding_box(points.rightCols(1)).min().array().isNaN().all());
}

} // namespace geometry_test

} // namespace fettle
