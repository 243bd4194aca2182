// Touching meshes and clouds. References: closed forms on planes, spheres, boxes; dense sampling; exact quadrics.
#include "sampling/point_surface.h"
#include "sampling/scan.h"
#include "sampling/triangle_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace fettle {
namespace scan_test {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Height = std::function<double(double, double)>;

// n x n cells over [0, side]^2
mesh::Mesh sheet(const Height& z, double side, int n)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (n + 1) * (n + 1));
    mesh.triangles.resize(3, 2 * n * n);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = side * i / n, y = side * j / n;
            mesh.vertices.col(j * (n + 1) + i) << x, y, z(x, y);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.col(2 * (j * n + i)) << a, b, d;
            mesh.triangles.col(2 * (j * n + i) + 1) << a, d, c;
        }
    return mesh;
}

mesh::Mesh box(const Vector3d& low, const Vector3d& high)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8);
    for (int i = 0; i < 8; ++i)
        mesh.vertices.col(i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
    mesh.triangles.resize(3, 12);
    mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, 2, 3, 5, 7, 1, 5, 7, 3, 4, 6, 3, 7, 3, 1, 7, 6, 5, 4, 6, 7, 6,
        2, 7, 5;
    return mesh;
}

cloud::Cloud cloud_of(const Height& z, double spacing, int n)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, n * n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) cloud.xyz.col(j * n + i) << spacing * i, spacing * j, z(spacing * i, spacing * j);
    return cloud;
}

// The ball's lowest point from a dense sampling of the surface under it: a lower bound that is off by at most
// (grid step)^2 / 8 R along z.
double dropped_by_sampling(const sampling::TriangleGrid& grid, const Vector2d& xy, double radius, int steps)
{
    double lowest = -1e9;
    for (int j = -steps; j <= steps; ++j)
        for (int i = -steps; i <= steps; ++i) {
            const Vector2d from = radius / steps * Vector2d(i, j);
            const double root = radius * radius - from.squaredNorm();
            const auto z = root >= 0 ? grid.highest(xy + from) : std::nullopt;
            if (z) lowest = std::max(lowest, *z + std::sqrt(root) - radius);
        }
    return lowest;
}

const Height kTilted = [](double x, double y) { return 3 + 0.2 * x - 0.5 * y; };

TEST(MeshScan, PlaneIsExactEverywhereItsEdgesToo)
{
    const sampling::Scan scan(sheet(kTilted, 10, 7));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 10);
    for (int i = 0; i < 500; ++i) {
        const Vector2d xy(uniform(random), uniform(random));
        ASSERT_TRUE(scan.height(xy));
        EXPECT_NEAR(*scan.height(xy), kTilted(xy.x(), xy.y()), 1e-13);
    }
    for (int i = 0; i <= 70; ++i) // along edges, diagonals and the border, through vertices
        for (const Vector2d& xy : {Vector2d(i / 7.0, 10.0 / 7), Vector2d(i / 7.0, i / 7.0), Vector2d(i / 7.0, 0)})
            ASSERT_TRUE(scan.height(xy)) << xy.transpose();
    EXPECT_FALSE(scan.height({-1e-9, 5}));
    EXPECT_FALSE(scan.height({5, 10 + 1e-9}));
    EXPECT_FALSE(scan.height({1e6, 1e6}));
}

TEST(MeshScan, NoRaySlipsBetweenTriangles)
{
    // vertices at irrational places, rays through points of the shared edges
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.04, 0.04);
    mesh::Mesh mesh = sheet([](double, double) { return 0; }, 10, 40);
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
        for (int k = 0; k < 2; ++k)
            if (mesh.vertices(k, i) > 0 && mesh.vertices(k, i) < 10) mesh.vertices(k, i) += uniform(random);
    const sampling::TriangleGrid grid(mesh);
    std::uniform_real_distribution<double> share(0, 1);
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k) {
            const double s = share(random);
            const Vector2d a = mesh.vertices.col(mesh.triangles(k, t)).head<2>();
            const Vector2d b = mesh.vertices.col(mesh.triangles((k + 1) % 3, t)).head<2>();
            const Vector2d xy = (1 - s) * a + s * b;
            if (xy.minCoeff() > 1e-9 && xy.maxCoeff() < 10 - 1e-9) {
                EXPECT_TRUE(grid.highest(xy)) << t;
            }
        }
}

TEST(MeshScan, TakesTheUpperSideOfABody)
{
    for (const bool inside_out : {false, true}) {
        mesh::Mesh mesh = box({0, 0, 0}, {4, 4, 2});
        if (inside_out) mesh.triangles.row(0).swap(mesh.triangles.row(1));
        const sampling::Scan scan(mesh);
        EXPECT_EQ(*scan.height({1, 3}), 2);
        EXPECT_EQ(*scan.height({0, 0}), 2); // the upright edge: its upper end
    }
}

TEST(MeshScan, BallOnAPlaneIsOffsetByTheSlope)
{
    // a ball of radius R over a plane of slope g: its lowest point is R (sqrt(1 + g²) - 1) above it
    const sampling::Scan scan(sheet(kTilted, 20, 9));
    const double lifted = 2 * (std::sqrt(1 + 0.04 + 0.25) - 1);
    for (const Vector2d& xy : {Vector2d(10, 10), Vector2d(7.3, 12.9), Vector2d(20.0 / 3, 20.0 / 3)})
        EXPECT_NEAR(*scan.drop_ball(xy, 2), kTilted(xy.x(), xy.y()) + lifted, 1e-12);
}

TEST(MeshScan, BallOnABoxMeetsFaceEdgeAndCorner)
{
    const sampling::Scan scan(box({0, 0, 0}, {4, 4, 2}));
    EXPECT_DOUBLE_EQ(*scan.drop_ball({2, 2}, 1), 2);                   // face
    EXPECT_DOUBLE_EQ(*scan.drop_ball({4.6, 2}, 1), 2 + 0.8 - 1);       // edge: sqrt(1 - .36) = .8
    EXPECT_DOUBLE_EQ(*scan.drop_ball({-0.36, -0.48}, 1), 2 + 0.8 - 1); // corner: .36² + .48² = .36
    EXPECT_FALSE(scan.drop_ball({5.1, 2}, 1));                         // passes by
    EXPECT_FALSE(scan.drop_ball({4.8, 4.8}, 1));                       // beside the corner
}

TEST(MeshScan, BallRestsOnASlopingEdge)
{
    // a roof along x with its ridge from (0, 2, 1) to (10, 2, 3), flanks so steep that the ball rides on the ridge
    mesh::Mesh roof;
    roof.vertices.resize(3, 6);
    roof.vertices << 0, 10, 0, 10, 0, 10, 2, 2, 0, 0, 4, 4, 1, 3, -20, -18, -20, -18;
    roof.triangles.resize(3, 4);
    roof.triangles << 0, 0, 0, 0, 2, 3, 1, 5, 3, 1, 5, 4;
    const sampling::Scan scan(roof);
    // over the ridge it is a plane of slope 0.2 for the ball; beside it by e, a cylinder of radius sqrt(R² - e²)
    const double slope = std::sqrt(1 + 0.2 * 0.2);
    EXPECT_NEAR(*scan.drop_ball({5, 2}, 1), 2 + slope - 1, 1e-12);
    EXPECT_NEAR(*scan.drop_ball({5, 2.05}, 1), 2 + std::sqrt(1 - 0.0025) * slope - 1, 1e-12);
}

TEST(MeshScan, BallAgreesWithDenseSampling)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0, 1);
    const mesh::Mesh rough = sheet([&](double, double) { return 2 * uniform(random); }, 10, 8);
    const sampling::TriangleGrid grid(rough);
    const sampling::Scan scan(rough);
    for (int trial = 0; trial < 40; ++trial) {
        const Vector2d xy(1 + 8 * uniform(random), 1 + 8 * uniform(random));
        const double radius = 0.2 + 2 * uniform(random);
        const double exact = *scan.drop_ball(xy, radius), sampled = dropped_by_sampling(grid, xy, radius, 150);
        EXPECT_LE(sampled, exact + 1e-12) << trial;
        // between samples a flank of the mesh falls by its slope (up to 2.3) times half a step
        EXPECT_GE(sampled, exact - 2.5 * radius / 150) << trial;
    }
}

TEST(MeshScan, LongThinTrianglesDoNotFillTheMemory)
{
    // a fan of slivers across the whole part
    mesh::Mesh fan;
    const int n = 2000;
    fan.vertices.resize(3, n + 2);
    fan.triangles.resize(3, n);
    fan.vertices.col(0) << 0, 0, 0;
    for (int i = 0; i <= n; ++i) fan.vertices.col(i + 1) << 100, 100.0 * i / n, 0;
    for (int i = 0; i < n; ++i) fan.triangles.col(i) << 0, i + 1, i + 2;
    const sampling::TriangleGrid grid(fan);
    EXPECT_EQ(*grid.highest({50, 25}), 0);
    EXPECT_FALSE(grid.highest({50, 51}));
}

TEST(CloudScan, QuadricIsReproducedExactly)
{
    const Height quadric = [](double x, double y) {
        return 1 + 0.3 * x - 0.2 * y + 0.05 * x * x - 0.03 * x * y + 0.02 * y * y;
    };
    const sampling::Scan scan(cloud_of(quadric, 0.5, 41));
    for (const Vector2d& xy : {Vector2d(10, 10), Vector2d(3.21, 14.9), Vector2d(17.77, 2.01)})
        EXPECT_NEAR(*scan.height(xy), quadric(xy.x(), xy.y()), 1e-10);
}

TEST(CloudScan, SpacingIsThatOfTheGrid)
{
    const auto flat = [](double, double) { return 0; };
    EXPECT_NEAR(sampling::PointSurface(cloud_of(flat, 0.5, 41).xyz).spacing(), 0.5, 0.02);
    // scan lines five times as far apart as the points on them
    Eigen::Matrix3Xd lines = cloud_of(flat, 0.2, 60).xyz;
    lines.row(1) *= 5;
    EXPECT_NEAR(sampling::PointSurface(lines).spacing(), std::sqrt(0.2 * 1.0), 0.1);
}

TEST(CloudScan, OutliersDoNotMoveTheSurface)
{
    cloud::Cloud cloud = cloud_of(kTilted, 0.5, 41);
    const Vector2d xy(10.1, 9.8);
    // three of the some 28 points near the line, off by more and by less than the gap between two sheets
    const double errors[] = {10, 0.5, 1};
    std::size_t spoiled = 0;
    for (Eigen::Index i = 0; i < cloud.size() && spoiled < 3; ++i)
        if ((cloud.xyz.col(i).head<2>() - xy).norm() < 1.2) cloud.xyz(2, i) += errors[spoiled++];
    ASSERT_EQ(spoiled, 3u);
    EXPECT_NEAR(*sampling::Scan(cloud).height(xy), kTilted(xy.x(), xy.y()), 1e-6);
}

// At the foot of a wall at 45 degrees a quadratic dips below the floor: by 0.071 spacings with the weights of a local
// regression, with equal ones by 0.092.
TEST(CloudScan, DipsLittleAtTheFootOfAWall)
{
    const auto foot = [](double x, double) { return std::max(x - 10, 0.0); };
    const sampling::Scan scan(cloud_of(foot, 0.5, 41));
    for (double x = 8; x < 10; x += 0.05) EXPECT_GT(*scan.height({x, 10.13}), -0.075 * 0.5) << x;
}

TEST(CloudScan, HolesAndBordersAreNoSurface)
{
    cloud::Cloud cloud = cloud_of(kTilted, 0.5, 41);
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if ((cloud.xyz.col(i).head<2>() - Vector2d(10, 10)).norm() < 3) cloud.xyz.col(i).setConstant(NAN);
    const sampling::Scan scan(cloud);
    EXPECT_FALSE(scan.height({10, 10}));
    EXPECT_FALSE(scan.height({8.0, 10})); // points on one side only
    EXPECT_TRUE(scan.height({6.4, 10}));
    EXPECT_FALSE(scan.height({-0.3, 10}));
    EXPECT_FALSE(scan.height({10, 30}));
    EXPECT_NEAR(scan.bounds().max().x(), 20, 1e-12);
}

TEST(CloudScan, UpperSheetOfAPlate)
{
    cloud::Cloud upper = cloud_of(kTilted, 0.5, 41);
    cloud::Cloud plate;
    plate.xyz.resize(3, 2 * upper.size());
    plate.xyz << upper.xyz, (upper.xyz.colwise() - Vector3d(0, 0, 4));
    EXPECT_NEAR(*sampling::Scan(plate).height({10.2, 9.7}), kTilted(10.2, 9.7), 1e-9);
}

TEST(CloudScan, TooFewPointsAreNoSurface)
{
    for (const int n : {0, 1, 2, 5}) {
        cloud::Cloud cloud;
        cloud.xyz = Eigen::Matrix3Xd::Random(3, n);
        EXPECT_FALSE(sampling::Scan(cloud).height({0, 0})) << n;
        EXPECT_FALSE(sampling::Scan(cloud).drop_ball({0, 0}, 1)) << n;
    }
    cloud::Cloud equal;
    equal.xyz = Eigen::Matrix3Xd::Ones(3, 50);
    EXPECT_FALSE(sampling::Scan(equal).height({1, 1}));
    cloud::Cloud line;
    line.xyz = Eigen::Matrix3Xd::Zero(3, 50);
    line.xyz.row(0).setLinSpaced(50, 0, 10);
    EXPECT_FALSE(sampling::Scan(line).height({5, 0}));
}

TEST(CloudScan, BallOnASphere)
{
    // a ball of radius r on a sphere of radius R: centres at distance R + r
    const double R = 50, r = 3;
    const Height sphere = [R](double x, double y) {
        return std::sqrt(R * R - (x - 10) * (x - 10) - (y - 10) * (y - 10));
    };
    const sampling::Scan scan(cloud_of(sphere, 0.5, 41));
    for (const Vector2d& xy : {Vector2d(10, 10), Vector2d(14, 12), Vector2d(6.1, 14.7)}) {
        const double expected = std::sqrt((R + r) * (R + r) - (xy - Vector2d(10, 10)).squaredNorm()) - r;
        // the local quadratic of a sphere is off by its fourth-order term, (3 spacings)^4 / 8 R^3
        EXPECT_NEAR(*scan.drop_ball(xy, r), expected, 1e-5);
    }
}

} // namespace scan_test
} // namespace fettle
