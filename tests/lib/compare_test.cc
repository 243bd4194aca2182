#include "cube.h"

#include "compare/areas.h"
#include "compare/signed_distance.h"
#include "draw/colours.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace fettle {
namespace compare_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::Matrix3Xd random_points(Eigen::Index count, double size, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-size, size);
    return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return place(random); });
}

double cube_distance(const Eigen::Vector3d& p)
{
    const Eigen::Vector3d q = p.cwiseAbs().array() - 1;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

// A square plate of two facets in z = 0, x and y from 0 to 10.
mesh::Mesh plate()
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.vertices << 0, 10, 10, 0, 0, 0, 10, 10, 0, 0, 0, 0;
    mesh.triangles.resize(3, 2);
    mesh.triangles << 0, 0, 1, 2, 2, 3;
    return mesh;
}

// Exact: the distance of a cube in closed form; among the points those over edges, corners and facets' extensions.
TEST(SignedDistance, CubeInClosedForm)
{
    Eigen::Matrix3Xd points = random_points(3000, 3, 1);
    for (Eigen::Index i = 0; i < 1000; ++i) // a lattice that contains the extensions of every facet and edge
        points.col(i) << -3 + i % 10 * 0.5, -3 + i / 10 % 10 * 0.5, -3 + i / 100 * 0.5;
    const compare::ErrorMap map = compare::signed_distance(points, cube(1));
    for (Eigen::Index i = 0; i < points.cols(); ++i) EXPECT_NEAR(map.error[i], cube_distance(points.col(i)), 1e-14);
}

// Independent: over single triangles the error is the height over the nearest one if the foot lies inside it, else
// undefined, for all their edges are open.
TEST(SignedDistance, TriangleSoupByBruteForce)
{
    constexpr Eigen::Index kTriangles = 60;
    mesh::Mesh soup;
    soup.vertices = random_points(3 * kTriangles, 5, 2);
    soup.triangles = Eigen::VectorXi::LinSpaced(3 * kTriangles, 0, 3 * kTriangles - 1).reshaped(3, kTriangles);
    const Eigen::Matrix3Xd points = random_points(2000, 6, 3);
    const compare::ErrorMap map = compare::signed_distance(points, soup);
    int defined = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3d p = points.col(i);
        double nearest = std::numeric_limits<double>::infinity(), expected = kNaN;
        for (Eigen::Index t = 0; t < kTriangles; ++t) {
            const Eigen::Matrix3d corners = soup.vertices.middleCols(3 * t, 3);
            const Eigen::Vector3d normal =
                (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
            const double height = normal.dot(p - corners.col(0));
            const Eigen::Vector3d weights = corners.fullPivLu().solve(p - height * normal);
            if (weights.minCoeff() >= 0 && std::abs(height) < nearest) {
                nearest = std::abs(height);
                expected = height;
            }
            for (int k = 0; k < 3; ++k) {
                const Eigen::Vector3d a = corners.col(k), edge = corners.col((k + 1) % 3) - a;
                const double along = std::clamp(edge.dot(p - a) / edge.squaredNorm(), 0.0, 1.0);
                if ((a + along * edge - p).norm() >= nearest - 1e-12) continue;
                nearest = (a + along * edge - p).norm();
                expected = kNaN;
            }
        }
        EXPECT_EQ(std::isnan(map.error[i]), std::isnan(expected)) << i;
        if (std::isnan(expected)) continue;
        ++defined;
        EXPECT_NEAR(map.error[i], expected, 1e-12);
    }
    EXPECT_GT(defined, 200);
}

// A hedgehog: a sphere of triangles with every other vertex pulled out. Star-shaped, so a point is inside exactly if it
// lies before the surface as seen from the centre, which decides the sign without any normal.
TEST(SignedDistance, SignOnSpikes)
{
    constexpr int kRings = 12, kSectors = 16;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, kRings * kSectors + 2);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> radius(0.5, 2);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double polar = std::numbers::pi * (i + 1) / (kRings + 1), turn = 2 * std::numbers::pi * j / kSectors;
            mesh.vertices.col(i * kSectors + j) =
                radius(random) *
                Eigen::Vector3d(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
        }
    const int north = kRings * kSectors, south = north + 1;
    mesh.vertices.col(north) << 0, 0, 1.5;
    mesh.vertices.col(south) << 0, 0, -0.6;
    std::vector<Eigen::Vector3i> facets;
    for (int j = 0; j < kSectors; ++j) {
        const int next = (j + 1) % kSectors, last = (kRings - 1) * kSectors;
        facets.emplace_back(north, j, next);
        facets.emplace_back(south, last + next, last + j);
        for (int i = 0; i + 1 < kRings; ++i) {
            const int a = i * kSectors + j, b = i * kSectors + next;
            facets.emplace_back(a, a + kSectors, b + kSectors);
            facets.emplace_back(a, b + kSectors, b);
        }
    }
    mesh.triangles = Eigen::Map<Eigen::Matrix3Xi>(facets[0].data(), 3, static_cast<Eigen::Index>(facets.size()));

    // Around the vertices and the middles of edges, where the sign is hard.
    const Eigen::Matrix3Xd jitter = random_points(6000, 0.3, 5);
    Eigen::Matrix3Xd points(3, jitter.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3i f = facets[static_cast<std::size_t>(i * 7) % facets.size()];
        points.col(i) = (mesh.vertices.col(f[0]) + mesh.vertices.col(f[i % 3])) / 2 + jitter.col(i);
    }
    const compare::ErrorMap map = compare::signed_distance(points, mesh);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        double reach = 0; // of the ray from the centre through the point, in units of the point's distance
        for (const Eigen::Vector3i& f : facets) {
            Eigen::Matrix3d corners;
            corners << mesh.vertices.col(f[0]), mesh.vertices.col(f[1]), mesh.vertices.col(f[2]);
            const Eigen::Vector3d weights = corners.fullPivLu().solve(points.col(i));
            if (weights.minCoeff() >= -1e-12) reach = 1 / weights.sum();
        }
        if (std::abs(map.error[i]) <= 1e-9) continue;
        EXPECT_EQ(map.error[i] > 0, reach < 1) << i;
    }
}

TEST(SignedDistance, RigidMotionChangesNothing)
{
    const mesh::Mesh mesh = cube(1);
    const Eigen::Matrix3Xd points = random_points(500, 2, 6);
    const Eigen::Isometry3d motion =
        Eigen::Translation3d(30, -20, 10) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    mesh::Mesh moved = mesh;
    moved.vertices = motion * mesh.vertices;
    const compare::ErrorMap here = compare::signed_distance(points, mesh);
    const compare::ErrorMap there = compare::signed_distance(motion * points, moved);
    EXPECT_LT((here.error - there.error).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((motion.linear() * here.normal - there.normal).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(SignedDistance, NothingBeyondAnOpenBorder)
{
    Eigen::Matrix3Xd points(3, 8);
    points.col(0) << 5, 5, 0.25;
    points.col(1) << 5, 10, -0.25;   // under the border itself
    points.col(2) << 10, 10, 2;      // over a corner
    points.col(3) << 5, 10.01, 0.25; // beyond
    points.col(4) << 10.01, 10.01, -1;
    points.col(5) << -0.001, 0, 0;    // beyond, in the plane
    points.col(6) << 10 + 1e-7, 5, 0; // on the border but for the rounding of floats
    points.col(7) << kNaN, 0, 0;
    const compare::ErrorMap map = compare::signed_distance(points, plate());
    EXPECT_DOUBLE_EQ(map.error[0], 0.25);
    EXPECT_DOUBLE_EQ(map.error[1], -0.25);
    EXPECT_DOUBLE_EQ(map.error[2], 2);
    for (const int i : {3, 4, 5, 7}) {
        EXPECT_TRUE(std::isnan(map.error[i])) << i;
        EXPECT_TRUE(map.normal.col(i).array().isNaN().all()) << i;
    }
    EXPECT_NEAR(map.error[6], 0, 1e-6);
}

// Quadrilaterals over shared corners, each cut in two.
mesh::Mesh of_quads(const Eigen::Matrix3Xd& corners, const std::vector<Eigen::Vector4i>& quads)
{
    mesh::Mesh mesh;
    mesh.vertices = corners;
    mesh.triangles.resize(3, 2 * static_cast<Eigen::Index>(quads.size()));
    for (std::size_t q = 0; q < quads.size(); ++q) {
        const auto t = 2 * static_cast<Eigen::Index>(q);
        mesh.triangles.col(t) << quads[q][0], quads[q][1], quads[q][2];
        mesh.triangles.col(t + 1) << quads[q][0], quads[q][2], quads[q][3];
    }
    return mesh;
}

// Corners of a profile in x-z at y = 0 and y = 10: 2 i and 2 i + 1.
Eigen::Matrix3Xd extruded(const std::vector<Eigen::Vector2d>& profile)
{
    Eigen::Matrix3Xd corners(3, 2 * static_cast<Eigen::Index>(profile.size()));
    for (std::size_t i = 0; i < profile.size(); ++i)
        for (int side = 0; side < 2; ++side)
            corners.col(2 * static_cast<Eigen::Index>(i) + side) << profile[i].x(), 10 * side, profile[i].y();
    return corners;
}

void expect_errors(const mesh::Mesh& mesh, const std::vector<std::pair<Eigen::Vector3d, double>>& expected)
{
    for (const auto& [point, error] : expected) {
        const double found = compare::signed_distance(point, mesh).error[0];
        if (std::isnan(error))
            EXPECT_TRUE(std::isnan(found)) << point.transpose();
        else
            EXPECT_NEAR(found, error, 1e-14) << point.transpose();
    }
}

// A step of 2 with its wall at x = 5, material below; distances and sides by hand.
TEST(SignedDistance, OfAStep)
{
    const mesh::Mesh step =
        of_quads(extruded({{0, 0}, {5, 0}, {5, 2}, {10, 2}}), {{0, 2, 3, 1}, {2, 4, 5, 3}, {4, 6, 7, 5}});
    expect_errors(step, {{{2, 5, 0.5}, 0.5},
                         {{2, 5, -0.25}, -0.25},
                         {{8, 5, 2.5}, 0.5},
                         {{4.5, 5, 1.5}, 0.5},                // before the wall
                         {{5.5, 5, 1.75}, -0.25},             // in the material, under the top
                         {{5.25, 5, 1}, -0.25},               // behind the wall
                         {{4.75, 5, 0.25}, 0.25},             // in the inner edge: wall and ground are as near
                         {{4.5, 5, 2.5}, std::sqrt(0.5)},     // beyond the outer edge
                         {{5.5, 5, -0.5}, -std::sqrt(0.5)}}); // below the inner edge
}

// Two plates with a slot between them, 4 < x < 6: over the slot there is no surface to be far from.
TEST(SignedDistance, OverAGap)
{
    const mesh::Mesh plates = of_quads(extruded({{0, 0}, {4, 0}, {6, 0}, {10, 0}}), {{0, 2, 3, 1}, {4, 6, 7, 5}});
    expect_errors(plates, {{{3.75, 5, 0.5}, 0.5},
                           {{4, 5, -0.5}, -0.5},
                           {{4.25, 5, 0.5}, kNaN},
                           {{5, 5, 0}, kNaN},
                           {{5.75, 5, -0.5}, kNaN},
                           {{6, 5, 0.25}, 0.25}});
}

// A plate with a fin on top: three facets at one edge, which is no border.
TEST(SignedDistance, OfAnEdgeOfThreeFacets)
{
    const mesh::Mesh fin =
        of_quads(extruded({{-5, 0}, {0, 0}, {5, 0}, {0, 3}}), {{0, 2, 3, 1}, {2, 4, 5, 3}, {2, 6, 7, 3}});
    expect_errors(fin, {{{0, 5, -0.5}, -0.5}, {{-1, 5, 0.25}, 0.25}, {{2, 5, -1}, -1}, {{1, 5, 0.5}, 0.5}});
}

TEST(SignedDistance, NothingBeyondMaxDistance)
{
    Eigen::Matrix3Xd points(3, 2);
    points << 5, 5, 5, 5, 0.9, 1.1;
    for (const compare::DistanceMode mode : {compare::DistanceMode::normal, compare::DistanceMode::direction}) {
        const compare::ErrorMap map = compare::signed_distance(points, plate(), {mode, Eigen::Vector3d::UnitZ(), 1});
        EXPECT_DOUBLE_EQ(map.error[0], 0.9);
        EXPECT_TRUE(std::isnan(map.error[1]));
    }
}

// A crack as CAD programs leave it, vertices that differ in the last bits of a float, is no border.
TEST(SignedDistance, CracksOfRoundingAreClosed)
{
    mesh::Mesh mesh = cube(1);
    mesh::Mesh soup;
    soup.vertices.resize(3, 36);
    for (int i = 0; i < 36; ++i)
        soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i % 3, i / 3)) * (1 + (i % 3 - 1) * 6e-8);
    soup.triangles = Eigen::VectorXi::LinSpaced(36, 0, 35).reshaped(3, 12);
    const Eigen::Matrix3Xd points = random_points(2000, 3, 7);
    const compare::ErrorMap map = compare::signed_distance(points, soup);
    for (Eigen::Index i = 0; i < points.cols(); ++i) EXPECT_NEAR(map.error[i], cube_distance(points.col(i)), 1e-6);
}

// A stray facet far away does not make one vertex of the cube's.
TEST(SignedDistance, StrayFacetsDoNotWeld)
{
    mesh::Mesh mesh = cube(1);
    mesh.vertices.conservativeResize(3, 11);
    mesh.vertices.rightCols(3) << 1e9, 2e9, 1e9, 1e9, 1e9, 2e9, 1e9, 1e9, 1e9;
    mesh.triangles.conservativeResize(3, 13);
    mesh.triangles.col(12) << 8, 9, 10;
    const Eigen::Matrix3Xd points = random_points(2000, 3, 8);
    const compare::ErrorMap map = compare::signed_distance(points, mesh);
    for (Eigen::Index i = 0; i < points.cols(); ++i) EXPECT_NEAR(map.error[i], cube_distance(points.col(i)), 1e-12);
}

// A duplicate facet does not close the borders.
TEST(SignedDistance, NothingBeyondTheBorderOfARepeatedFacet)
{
    mesh::Mesh mesh = plate();
    mesh.triangles = mesh.triangles.replicate(1, 2).eval();
    Eigen::Matrix3Xd points(3, 2);
    points << 5, 12, 3, 3, 1, 1;
    const compare::ErrorMap map = compare::signed_distance(points, mesh);
    EXPECT_EQ(map.error[0], 1);
    EXPECT_TRUE(std::isnan(map.error[1]));
}

// A ridge whose two sides share no edge: on one side it is cut in two, and a facet without area fills the gap.
TEST(SignedDistance, IgnoresFacetsWithoutArea)
{
    mesh::Mesh ridge;
    ridge.vertices.resize(3, 5);
    ridge.vertices << 0, 2, 4, 2, 2, /* y */ 0, 0, 0, -3, 3, /* z */ 0, 0, 0, -6, -6;
    ridge.triangles.resize(3, 4); // a, b, c along the crest; one facet before it, two behind, the needle between
    ridge.triangles.transpose() << 3, 2, 0, 0, 2, 1, 0, 1, 4, 1, 2, 4;
    Eigen::Matrix3Xd points(3, 3);
    points << 1, 3, 2, 0.5, 0.5, -0.5, 0.3, 0.3, 0.3;
    const compare::ErrorMap map = compare::signed_distance(points, ridge);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(map.error[i], std::hypot(0.5, 0.3), 1e-12) << i;
}

// The needle is as wide as rounding leaves it, and points lie over its inside: it has no normal from which the side
// follows.
TEST(SignedDistance, LooksThroughNeedlesThatItStandsOver)
{
    constexpr double kWide = 1e-4, kOver = 0.01, kFar = 1000; // where floats are 6e-5 apart
    mesh::Mesh ridge;
    ridge.vertices.resize(3, 5);
    ridge.vertices << 0, 2, 4, 2, 2, /* y */ 0, kWide, 0, -3, 3, /* z */ 0, 0, 0, -6, -6;
    ridge.triangles.resize(3, 4);
    ridge.triangles.transpose() << 3, 2, 0, 0, 1, 2, 0, 4, 1, 1, 4, 2; // the needle's back is up
    Eigen::Matrix3Xd points(3, 2);
    points << 1, 3, kWide / 4, kWide / 4, kOver, kOver;
    ridge.vertices.row(0).array() += kFar;
    points.row(0).array() += kFar;
    for (const bool up : {false, true}) {
        if (up) ridge.triangles.row(1).swap(ridge.triangles.row(2));
        const compare::ErrorMap map = compare::signed_distance(points, ridge);
        for (int i = 0; i < 2; ++i) EXPECT_NEAR(map.error[i], up ? kOver : -kOver, 1e-12) << i;
    }
}

TEST(SignedDistance, AlongADirection)
{
    // Inside a solid the line counts to the surface that faces the direction, however near the other side is.
    Eigen::Matrix3Xd points(3, 5);
    points.col(0) << 0.3, 0.2, -0.9;
    points.col(1) << 0.3, 0.2, 1.25;
    points.col(2) << 0.3, 0.2, 1; // on it
    points.col(3) << 1.3, 0, 1;   // the line misses the cube
    points.col(4) << 0, 0, 1;     // over the diagonal of the facets
    const compare::ErrorMap z = compare::signed_distance(points, cube(1), {compare::DistanceMode::direction});
    EXPECT_NEAR(z.error[0], -1.9, 1e-14);
    EXPECT_NEAR(z.error[1], 0.25, 1e-14);
    EXPECT_NEAR(z.error[2], 0, 1e-14);
    EXPECT_TRUE(std::isnan(z.error[3]));
    EXPECT_NEAR(z.error[4], 0, 1e-14);

    const Eigen::Vector3d slanted = Eigen::Vector3d(3, 0, 4) / 5;
    const compare::ErrorMap along =
        compare::signed_distance(points.col(1), cube(1), {compare::DistanceMode::direction, slanted});
    EXPECT_NEAR(along.error[0], 0.25 / 0.8, 1e-14); // height over the cosine
}

// --- clouds as references
// ---------------------------------------------------------------------------------------------

constexpr double kRadius = 50;

// The cap of a sphere over a square of side 20, centre (0, 0, -50).
cloud::Cloud cap(double spacing)
{
    cloud::Cloud cloud;
    const int n = static_cast<int>(std::lround(20 / spacing)) + 1;
    cloud.xyz.resize(3, n * n);
    for (int i = 0; i < n * n; ++i) {
        const double x = -10 + i % n * spacing, y = -10 + i / n * spacing;
        cloud.xyz.col(i) << x, y, std::sqrt(kRadius * kRadius - x * x - y * y) - kRadius;
    }
    return cloud;
}

double cap_error(double spacing, const compare::DistanceOptions& options)
{
    Eigen::Matrix3Xd points = random_points(300, 8, 8);
    points.row(2) =
        points.row(2) / 8 - (points.row(0).array().square() + points.row(1).array().square()).matrix() / 100;
    const compare::ErrorMap map = compare::signed_distance(points, cap(spacing), options);
    double worst = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3d p = points.col(i) + Eigen::Vector3d(0, 0, kRadius);
        const double exact = options.mode == compare::DistanceMode::normal
                                 ? p.norm() - kRadius
                                 : p.z() - std::sqrt(kRadius * kRadius - p.head<2>().squaredNorm());
        worst = std::max(worst, std::abs(map.error[i] - exact)); // NaN would not pass the comparison below
        if (std::isnan(map.error[i])) return kNaN;
    }
    return worst;
}

// A quadratic misses a sphere by its fourth order, h⁴/R³; taken along z on a slope by the third, which is a share of
// the slope times h³/R².
TEST(CloudReference, ConvergesOnASphere)
{
    for (const compare::DistanceMode mode : {compare::DistanceMode::normal, compare::DistanceMode::direction}) {
        const double coarse = cap_error(1, {mode}), fine = cap_error(0.5, {mode});
        EXPECT_LT(coarse, std::pow(3.0, 4) / std::pow(kRadius, 3)); // the neighbourhood reaches three spacings
        EXPECT_GT(std::log2(coarse / fine), mode == compare::DistanceMode::normal ? 3.5 : 2.8);
    }
}

TEST(CloudReference, NothingInHolesOrBeyondTheBorder)
{
    const cloud::Cloud whole = cap(0.5);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < whole.size(); ++i)
        if (whole.xyz.col(i).norm() > 4) kept.push_back(i);
    Eigen::Matrix3Xd points(3, 4);
    points << 0, 10.1, 8, 0, /* y */ 0, 0, 0, 11, /* z */ 0.1, -1, -0.6, -1;
    const compare::ErrorMap map = compare::signed_distance(points, cloud::select_points(whole, kept));
    EXPECT_TRUE(std::isnan(map.error[0]));
    EXPECT_TRUE(std::isnan(map.error[1]));
    EXPECT_FALSE(std::isnan(map.error[2]));
    EXPECT_TRUE(std::isnan(map.error[3]));
}

TEST(CloudReference, NormalsSayWhichSideIsOut)
{
    cloud::Cloud cloud = cap(0.5);
    Eigen::Matrix3Xd points(3, 1);
    points << 1, 2, 0.3;
    const double up = compare::signed_distance(points, cloud).error[0];
    EXPECT_GT(up, 0);
    cloud::set_normals(cloud, -Eigen::Vector3d::UnitZ().replicate(1, cloud.size()));
    EXPECT_DOUBLE_EQ(compare::signed_distance(points, cloud).error[0], -up);
}

TEST(CloudReference, OutliersDoNotPull)
{
    cloud::Cloud cloud = cap(0.5);
    for (Eigen::Index i = 7; i < cloud.size(); i += 29) cloud.xyz(2, i) += 3; // every 29th is an outlier
    Eigen::Matrix3Xd points = random_points(200, 8, 9);
    points.row(2) = (kRadius * kRadius - points.topRows<2>().colwise().squaredNorm().array()).sqrt() - kRadius;
    const compare::ErrorMap map = compare::signed_distance(points, cloud, {compare::DistanceMode::direction});
    EXPECT_LT(map.error.cwiseAbs().maxCoeff(), 1e-3);
}

// --- areas and colours
// -------------------------------------------------------------------------------------------------

Eigen::VectorXd areas_of(const Eigen::Matrix3Xd& points)
{
    const auto cloud = std::make_shared<cloud::Cloud>();
    cloud->xyz = points;
    return compare::PlanAreas(cloud::make_point_source(cloud))(points);
}

TEST(Areas, OfATurnedGridAreItsCells)
{
    const Eigen::Rotation2Dd turn(0.4);
    Eigen::Matrix3Xd points(3, 300 * 200);
    for (int i = 0; i < points.cols(); ++i) {
        const Eigen::Vector2d xy = turn * Eigen::Vector2d(i % 300 * 0.1, i / 300 * 0.25);
        points.col(i) << static_cast<float>(xy.x() + 100), static_cast<float>(xy.y() - 50), std::sin(i);
    }
    points(2, 17) = kNaN;
    const Eigen::VectorXd areas = areas_of(points);
    EXPECT_EQ(areas[17], 0);
    EXPECT_NEAR(areas[18], 0.1 * 0.25, 1e-7);
    EXPECT_EQ(areas[18], areas[40000]);
}

TEST(Areas, AreZeroWhereNoPointIsFinite)
{
    EXPECT_EQ(areas_of(Eigen::Matrix3Xd::Constant(3, 40, kNaN)), Eigen::VectorXd::Zero(40));
}

// The sum over a scattered cloud is the area it covers, but for half a square of 16 points along the border: 1 %.
TEST(Areas, OfAScatteredCloudSumUp)
{
    const Eigen::Matrix3Xd points = random_points(100000, 10, 10);
    EXPECT_NEAR(areas_of(points).sum(), 400, 8);
}

// Identity: the areas of an offset cube's vertices sum up to its whole surface, and along z to twice its shadow.
TEST(Areas, OfVertices)
{
    EXPECT_DOUBLE_EQ(compare::vertex_areas(cube(1)).sum(), 24);
    EXPECT_DOUBLE_EQ(compare::vertex_areas(cube(1), Eigen::Vector3d::UnitZ()).sum(), 8);
}

TEST(Colours, SignsHaveDifferentColours)
{
    const draw::ColourScale scale{0.5};
    EXPECT_EQ(scale(kNaN), draw::kUndefinedColour);
    EXPECT_EQ(scale(0), (draw::Rgb{247, 247, 247}));
    EXPECT_EQ(scale(-9), (draw::Rgb{103, 0, 31}));
    EXPECT_EQ(scale(0.5), (draw::Rgb{5, 48, 97}));
    EXPECT_EQ(draw::colour_scale(Eigen::Vector3d(1, kNaN, -3), 0.25).limit, 0.5);
    EXPECT_EQ(draw::colour_scale(Eigen::Vector3d(kNaN, kNaN, kNaN), 0).limit, 1);
}

} // namespace compare_test
} // namespace fettle
