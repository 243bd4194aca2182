#include "geometry/planar_grid.h"
#include "geometry/point_index.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace fettle {
namespace point_index_test {

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

TEST(PointIndex, AgreeWithBruteForce)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1e3, 1e3);
    const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 1000, [&] { return place(random); });
    const geometry::PointIndex<3> neighbours(points);
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d query = Eigen::Vector3d::NullaryExpr([&] { return 1.5 * place(random); });
        EXPECT_EQ(neighbours.nearest(query, 17), by_brute_force(points, query, 17));
    }
}

// On a lattice most distances are ties; a NaN point is none.
TEST(PointIndex, NearestWithinIsTheNearestIfItIsNear)
{
    const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 500);
    const geometry::PointIndex<3> neighbours(points);
    for (int k = 0; k < 200; ++k) {
        const Eigen::Vector3d query = 2 * Eigen::Vector3d::Random();
        const Eigen::Index nearest = neighbours.nearest(query, 1).front();
        const double distance = (points.col(nearest) - query).norm();
        EXPECT_EQ(neighbours.nearest_within(query, distance * (1 + 1e-12)), nearest);
        EXPECT_EQ(neighbours.nearest_within(query, distance * (1 - 1e-12)), std::nullopt);
    }
}

TEST(PointIndex, BreaksTiesByColumn)
{
    Eigen::Matrix3Xd points(3, 1000);
    for (int i = 0; i < 1000; ++i) points.col(i) << i % 10, i / 10 % 10, i / 100;
    points(1, 555) = std::numeric_limits<double>::quiet_NaN();
    const geometry::PointIndex<3> neighbours(points);
    EXPECT_EQ(neighbours.size(), 999);
    for (const Eigen::Vector3d& query :
         {Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(4.5, 4.5, 0), Eigen::Vector3d(-3, 0, 0)})
        EXPECT_EQ(neighbours.nearest(query, 24), by_brute_force(points, query, 24));
}

// Brute force on a lattice, where many points are just at the radius; then in a plane.
TEST(PointIndex, RadiusSearchAgreesWithBruteForce)
{
    Eigen::Matrix3Xd points(3, 1000);
    for (int i = 0; i < 1000; ++i) points.col(i) << i % 10, i / 10 % 10, i / 100;
    points(1, 555) = std::numeric_limits<double>::quiet_NaN();
    const geometry::PointIndex<3> space(points);
    const geometry::PointIndex<2> plane(points.topRows<2>());
    for (const double radius : {0.0, 1.0, 2.0, 2.5, 100.0})
        for (const Eigen::Vector3d& query : {Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(-1, 4.5, 0)}) {
            std::vector<Eigen::Index> in_space, in_plane;
            for (Eigen::Index i = 0; i < points.cols(); ++i) {
                const Eigen::Vector3d d = points.col(i) - query;
                if (d.squaredNorm() <= radius * radius) in_space.push_back(i);
                if (d.head<2>().squaredNorm() <= radius * radius) in_plane.push_back(i);
            }
            EXPECT_EQ(space.radius_search(query, radius), in_space);
            EXPECT_EQ(plane.radius_search(query.head<2>(), radius), in_plane);
        }
    EXPECT_EQ(plane.nearest({3, 7}, 3), (std::vector<Eigen::Index>{73, 173, 273}));
}

// Each point is in its cell, the cells follow each other, and those that meet a box hold all of its points.
TEST(PlanarGrid, CellsOfABoxHoldItsPoints)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-30, 70);
    const Eigen::Matrix2Xd points = Eigen::Matrix2Xd::NullaryExpr(2, 1000, [&] { return place(random); });
    const geometry::PlanarGrid grid = geometry::planar_grid(points, 4);
    EXPECT_NEAR(grid.count.prod(), 250, 40);
    for (int y = 0; y < grid.count.y(); ++y)
        for (int x = 0; x < grid.count.x(); ++x)
            for (Eigen::Index k = grid.begin[x + y * grid.count.x()]; k < grid.begin[x + y * grid.count.x() + 1]; ++k)
                EXPECT_TRUE((grid.cell_of(points.col(grid.order[k])) == Eigen::Array2i(x, y)).all());
    for (int i = 0; i < 100; ++i) {
        const Eigen::AlignedBox2d box(points.col(i) - Eigen::Vector2d(9, 5), points.col(i) + Eigen::Vector2d(1, 12));
        std::vector<Eigen::Index> found, expected;
        geometry::visit_cells(grid, box.min(), box.max(), [&](Eigen::Index k) {
            if (box.contains(points.col(grid.order[k]))) found.push_back(grid.order[k]);
        });
        for (Eigen::Index j = 0; j < points.cols(); ++j)
            if (box.contains(points.col(j))) expected.push_back(j);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
    }
}

TEST(PlanarGrid, PointsOnALineOrAtOnePlace)
{
    Eigen::Matrix2Xd line = Eigen::Matrix2Xd::Zero(2, 100);
    line.row(0).setLinSpaced(0, 99);
    EXPECT_EQ(geometry::planar_grid(line, 2).count.y(), 1);
    EXPECT_LE(geometry::planar_grid(line, 2).count.x(), 51);
    EXPECT_EQ(geometry::planar_grid(Eigen::Matrix2Xd::Ones(2, 3), 1).order, (std::vector<int>{0, 1, 2}));
}

TEST(PointIndex, FewPoints)
{
    EXPECT_TRUE(geometry::PointIndex<3>(Eigen::Matrix3Xd(3, 0)).nearest({0, 0, 0}, 5).empty());
    EXPECT_EQ(geometry::PointIndex<3>(Eigen::Matrix3Xd::Zero(3, 3)).nearest({1, 0, 0}, 5),
              (std::vector<Eigen::Index>{0, 1, 2}));
}

} // namespace point_index_test
} // namespace fettle
