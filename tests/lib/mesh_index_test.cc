#include "mesh/mesh_index.h"
#include "mesh/triangle.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace fettle {
namespace mesh_index_test {

mesh::Mesh soup(int triangles, double size, std::mt19937& random,
                const Eigen::Vector3d& centre = Eigen::Vector3d::Zero())
{
    std::uniform_real_distribution<double> place(-1, 1);
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 3 * triangles);
    mesh.triangles.resize(3, triangles);
    for (int t = 0; t < triangles; ++t) {
        const Eigen::Vector3d middle(place(random), place(random), place(random));
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d offset(place(random), place(random), place(random));
            mesh.vertices.col(3 * t + k) = centre + middle + size * offset;
            mesh.triangles(k, t) = 3 * t + k;
        }
        if (t % 10 == 0) mesh.vertices.col(3 * t + 2) = mesh.vertices.col(3 * t);     // without area
        if (t % 10 == 5) mesh.vertices.col(3 * t + 2) = mesh.vertices.col(3 * t + 1); // a point twice
    }
    return mesh;
}

// n x n cells of unit size, both diagonals in turn, z = 0 but for some hills at whole places.
mesh::Mesh grid(int n)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (n + 1) * (n + 1));
    mesh.triangles.resize(3, 2 * n * n);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) mesh.vertices.col(j * (n + 1) + i) << i, j, (i * j) % 3;
    int t = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            const bool other = (i + j) % 2 == 1;
            mesh.triangles.col(t++) << a, b, (other ? d : c);
            mesh.triangles.col(t++) << (other ? b : a), c, d;
        }
    return mesh;
}

// The smallest of the distances to the corners, to the edges whose foot lies on them, and to the plane if its foot (by
// QR) lies inside.
double brute_distance(const mesh::Triangle& corners, const Eigen::Vector3d& point)
{
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d a = corners.col(k), b = corners.col((k + 1) % 3);
        const double length = (b - a).norm();
        best = std::min(best, (point - a).norm());
        if (length == 0) continue;
        const double along = (point - a).dot(b - a) / length;
        if (along > 0 && along < length) best = std::min(best, (point - a - (b - a) * (along / length)).norm());
    }
    const Eigen::Vector3d a = corners.col(0);
    Eigen::Matrix<double, 3, 2> edges;
    edges << corners.col(1) - a, corners.col(2) - a;
    const auto qr = edges.colPivHouseholderQr();
    if (qr.rank() == 2) {
        const Eigen::Vector2d vw = qr.solve(point - a);
        if (vw.minCoeff() >= 0 && vw.sum() <= 1) best = std::min(best, (point - a - edges * vw).norm());
    }
    return best;
}

mesh::Triangle corners_of(const mesh::Mesh& mesh, Eigen::Index t)
{
    mesh::Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, t));
    return corners;
}

// The nearest triangle and its nearest point, by looking at all of them in double.
std::pair<Eigen::Index, mesh::TrianglePoint> closest_of_all(const mesh::Mesh& mesh, const Eigen::Vector3d& point)
{
    std::pair<Eigen::Index, mesh::TrianglePoint> closest{-1, {}};
    closest.second.squared_distance = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        if (const mesh::TrianglePoint other = mesh::closest_on_triangle(corners_of(mesh, t), point);
            other.squared_distance < closest.second.squared_distance)
            closest = {t, other};
    return closest;
}

// Möller and Trumbore's test, an independent formula.
double brute_cast(const mesh::Mesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)
{
    double best = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const mesh::Triangle c = corners_of(mesh, t);
        const Eigen::Vector3d e1 = c.col(1) - c.col(0), e2 = c.col(2) - c.col(0), s = origin - c.col(0);
        const Eigen::Vector3d p = direction.cross(e2), q = s.cross(e1);
        const double det = e1.dot(p);
        if (det == 0) continue;
        const double u = s.dot(p) / det, v = direction.dot(q) / det, distance = e2.dot(q) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && distance >= 0) best = std::min(best, distance);
    }
    return best;
}

TEST(MeshIndex, ClosestIsThatOfBruteForceOnSoups)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-2, 2);
    for (const double size : {0.01, 0.3, 2.0})
        for (const double shift : {0.0, 1e4}) {
            const Eigen::Vector3d centre = Eigen::Vector3d::Constant(shift);
            const mesh::Mesh mesh = soup(300, size, random, centre);
            const mesh::MeshIndex index(mesh);
            for (int i = 0; i < 300; ++i) {
                const Eigen::Vector3d point = centre + Eigen::Vector3d(place(random), place(random), place(random));
                double expected = std::numeric_limits<double>::infinity();
                for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
                    expected = std::min(expected, brute_distance(corners_of(mesh, t), point));
                const auto found = index.closest(point, std::numeric_limits<double>::infinity());
                ASSERT_TRUE(found);
                // Both round; the scale of the rounding is the size of the coordinates.
                const double tolerance = 1e-14 * (10 + 10 * shift);
                EXPECT_NEAR((found->point - point).norm(), expected, tolerance);
                const Eigen::Vector3d rebuilt = corners_of(mesh, found->triangle) * found->barycentric;
                EXPECT_NEAR((rebuilt - found->point).norm(), 0, tolerance);
                EXPECT_GE(found->barycentric.minCoeff(), 0);
                EXPECT_FALSE(index.closest(point, expected - 1e-9 * (1 + shift)));
                EXPECT_TRUE(index.closest(point, expected + 1e-9 * (1 + shift)));
            }
        }
}

// Triangles of a micrometre beside such of a metre, which leaves hold in steps of the largest one's.
TEST(MeshIndex, ClosestOfTrianglesOfAllSizesIsThatOfBruteForce)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1, 1), exponent(-3, 3);
    for (int round = 0; round < 20; ++round) {
        mesh::Mesh mesh = soup(100, 1, random);
        for (int t = 0; t < 100; ++t) {
            const double size = std::pow(10, exponent(random));
            const Eigen::Vector3d middle =
                std::min(size, 1.0) * Eigen::Vector3d(place(random), place(random), place(random));
            for (int k = 0; k < 3; ++k) mesh.vertices.col(3 * t + k) = middle + size * mesh.vertices.col(3 * t + k);
        }
        const mesh::MeshIndex index(mesh);
        for (int i = 0; i < 300; ++i) {
            const double off = std::pow(10, exponent(random));
            const Eigen::Vector3d point =
                mesh.vertices.col(i) + off * Eigen::Vector3d(place(random), place(random), place(random));
            const auto [triangle, nearest] = closest_of_all(mesh, point);
            const auto found = index.closest(point, std::numeric_limits<double>::infinity());
            ASSERT_TRUE(found);
            EXPECT_EQ(found->triangle, triangle);
            EXPECT_EQ(found->point, nearest.point);
        }
    }
}

// All facets within a distance, and only such whose boxes are; at distance 0 those at a vertex.
TEST(MeshIndex, NearbyIsThatOfBruteForceOnSoups)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-2, 2), radius(0, 1);
    for (const double size : {0.01, 0.3, 2.0})
        for (const double shift : {0.0, 1e4}) {
            const Eigen::Vector3d centre = Eigen::Vector3d::Constant(shift);
            const mesh::Mesh mesh = soup(300, size, random, centre);
            const mesh::MeshIndex index(mesh);
            const double tolerance = 1e-6 * (1 + shift); // of floats
            for (int i = 0; i < 300; ++i) {
                const bool at_vertex = i % 3 == 0;
                const Eigen::Vector3d point =
                    at_vertex ? Eigen::Vector3d(mesh.vertices.col(3 * i))
                              : Eigen::Vector3d(centre + Eigen::Vector3d(place(random), place(random), place(random)));
                const double distance = at_vertex ? 0 : radius(random);
                const std::vector<std::uint32_t> found = index.nearby(point, distance);
                EXPECT_TRUE(std::ranges::is_sorted(found));
                for (std::uint32_t t = 0; t < mesh.triangles.cols(); ++t) {
                    const mesh::Triangle corners = corners_of(mesh, t);
                    const Eigen::AlignedBox3d box(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff());
                    const bool is_found = std::ranges::binary_search(found, t);
                    if (brute_distance(corners, point) <= distance) EXPECT_TRUE(is_found);
                    if (box.exteriorDistance(point) > distance + tolerance) EXPECT_FALSE(is_found);
                }
            }
        }
}

// A torus of 4 000 facets with a bump here and there.
mesh::Mesh torus()
{
    const int across = 50, along = 40;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, across * along);
    mesh.triangles.resize(3, 2 * across * along);
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < across; ++i) {
            const double u = 2 * std::numbers::pi * i / across, v = 2 * std::numbers::pi * j / along;
            const double r = 30 + (i % 7 == 0 && j % 5 == 0 ? 2 : 0), ring = 100 + r * std::cos(v);
            mesh.vertices.col(j * across + i) << ring * std::cos(u), ring * std::sin(u), r * std::sin(v);
            const int a = j * across + i, b = j * across + (i + 1) % across;
            const int d = (j + 1) % along * across + i, c = (j + 1) % along * across + (i + 1) % across;
            mesh.triangles.col(2 * a) << a, b, c;
            mesh.triangles.col(2 * a + 1) << a, c, d;
        }
    return mesh;
}

// Points near a curved surface, far from it and near its medial axis, where much of it is equally far; wherever the
// search begins. The nearest facet is that of brute force, too: of equally near ones the first.
TEST(MeshIndex, ClosestIsThatOfBruteForceOnCurvedSurfaces)
{
    const mesh::Mesh mesh = torus();
    const mesh::MeshIndex index(mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi), unit(0, 1);
    for (const double far : {1e-3, 1.0, 29.99, 1e3, 1e6})
        for (int i = 0; i < 100; ++i) {
            const double u = turn(random), v = turn(random), r = 30 - far * (far < 30 ? unit(random) : -1);
            const double ring = 100 + r * std::cos(v);
            const Eigen::Vector3d point =
                i % 2 == 0 && far > 30 ? mesh.vertices.col(i) * (1 + far / 130)
                                       : Eigen::Vector3d(ring * std::cos(u), ring * std::sin(u), r * std::sin(v));
            const auto [triangle, nearest] = closest_of_all(mesh, point);
            for (const std::uint32_t leaf : {0u, 123u, 499u, 1u << 31}) {
                const auto found = index.closest(point, std::numeric_limits<double>::infinity(), leaf);
                ASSERT_TRUE(found);
                EXPECT_EQ(found->triangle, triangle);
                EXPECT_EQ(found->point, nearest.point);
            }
            const double distance = std::sqrt(nearest.squared_distance);
            EXPECT_TRUE(index.closest(point, distance * (1 + 1e-12)));
            EXPECT_FALSE(index.closest(point, distance * (1 - 1e-12)));
        }
}

// A damaged file: some vertices of a torus are up to a light second off. What is near it is found as exactly as ever,
// by closest points and by rays. Reference: all triangles, in double.
TEST(MeshIndex, VerticesFarOffDisturbNothing)
{
    mesh::Mesh mesh = torus();
    mesh.vertices.col(777) << 3.84e8, 1.1e8, -2e8;
    mesh.vertices.col(1500) << -3e11, 0, 5;
    mesh.vertices.col(1800) << 0, 9e4, 9e4;
    const mesh::MeshIndex index(mesh);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-150, 150);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const Eigen::Vector3d point(place(random), place(random), place(random) / 3);
        const auto [triangle, nearest] = closest_of_all(mesh, point);
        const auto found = index.closest(point, std::numeric_limits<double>::infinity());
        ASSERT_TRUE(found);
        EXPECT_EQ(found->triangle, triangle);
        EXPECT_EQ(found->point, nearest.point);

        const Eigen::Vector3d direction =
            (Eigen::Vector3d(place(random), place(random), place(random) / 3) - point).normalized();
        const mesh::WatertightRay ray(point, direction);
        double expected = std::numeric_limits<double>::infinity();
        for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
            expected = std::min(expected, ray.hit(corners_of(mesh, t)).value_or(expected));
        const auto hit = index.cast(point, direction);
        ASSERT_EQ(hit.has_value(), std::isfinite(expected));
        if (!hit) continue;
        EXPECT_EQ(hit->distance, expected);
        ++hits;
    }
    EXPECT_GT(hits, 100);
}

// A cone of a thousand needles: over its apex all of them are equally near, from any leaf on. The first one counts.
TEST(MeshIndex, OfNeedlesAtTheNearestVertexTheFirst)
{
    const int needles = 1000;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, needles + 1);
    mesh.triangles.resize(3, needles);
    mesh.vertices.col(needles) << 0, 0, 5;
    for (int i = 0; i < needles; ++i) {
        const double turn = 2 * std::numbers::pi * i / needles;
        mesh.vertices.col(i) << std::cos(turn), std::sin(turn), 0;
        mesh.triangles.col(i) << needles, i, (i + 1) % needles;
    }
    const mesh::MeshIndex index(mesh);
    for (std::uint32_t leaf = 0; leaf < 125; ++leaf) {
        const auto found = index.closest({0, 0, 7}, 10, leaf);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->triangle, 0);
        EXPECT_EQ(found->point, Eigen::Vector3d(0, 0, 5));
    }
}

TEST(MeshIndex, BarycentricIsExactlyZeroOffEdgesAndVertices)
{
    const mesh::Mesh mesh = grid(4);
    const mesh::MeshIndex index(mesh);
    const auto corner = index.closest({-1, -1, -1}, 100);
    ASSERT_TRUE(corner);
    EXPECT_EQ((corner->barycentric.array() == 0).count(), 2);
    EXPECT_EQ(corner->barycentric.maxCoeff(), 1);
    EXPECT_EQ(corner->point, Eigen::Vector3d(0, 0, 0));
    const auto edge = index.closest({0.5, -1, -1}, 100);
    ASSERT_TRUE(edge);
    EXPECT_EQ((edge->barycentric.array() == 0).count(), 1);
    EXPECT_EQ(edge->point, Eigen::Vector3d(0.5, 0, 0));
}

TEST(MeshIndex, CastIsThatOfBruteForceOnSoups)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-1.5, 1.5);
    int hits = 0;
    for (const double size : {0.05, 0.5}) {
        const mesh::Mesh mesh = soup(500, size, random);
        const mesh::MeshIndex index(mesh);
        for (int i = 0; i < 1000; ++i) {
            const Eigen::Vector3d origin = (i % 2 == 0 ? 1.0 : 1e4) * Eigen::Vector3d(place(random), place(random), 2);
            const Eigen::Vector3d aim(place(random), place(random), place(random));
            const Eigen::Vector3d direction = (aim - origin).normalized();
            const double expected = brute_cast(mesh, origin, direction);
            const auto found = index.cast(origin, direction);
            ASSERT_EQ(found.has_value(), std::isfinite(expected));
            if (!found) continue;
            ++hits;
            EXPECT_NEAR(found->distance, expected, 1e-11 * std::max(1.0, origin.norm()) * 100);
        }
    }
    EXPECT_GT(hits, 300);
}

// Vertical rays exactly through vertices, edges and diagonals find the surface, at its exact height.
TEST(MeshIndex, VerticalRaysThroughVerticesAndEdges)
{
    const int n = 8;
    const mesh::Mesh mesh = grid(n);
    const mesh::MeshIndex index(mesh);
    for (int j = 0; j <= 2 * n; ++j)
        for (int i = 0; i <= 2 * n; ++i) {
            const auto found = index.highest(0.5 * i, 0.5 * j);
            ASSERT_TRUE(found) << i << ' ' << j;
            if (i % 2 == 0 && j % 2 == 0) {
                EXPECT_EQ(found->point.z(), (i / 2 * (j / 2)) % 3);
            }
        }
    EXPECT_FALSE(index.highest(-1e-12, 1));
    EXPECT_FALSE(index.highest(n + 1e-12, 1));
}

// Edges in general position: a point computed on the common edge of two triangles lies a rounding off it, and must hit
// one of the two all the same.
TEST(MeshIndex, NoCracksBetweenNeighbours)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-100, 100), part(0, 1);
    for (int trial = 0; trial < 2000; ++trial) {
        mesh::Mesh mesh;
        mesh.vertices.resize(3, 4);
        for (int k = 0; k < 4; ++k) mesh.vertices.col(k) << place(random), place(random), place(random);
        const Eigen::Vector2d a = mesh.vertices.col(0).head<2>(), b = mesh.vertices.col(1).head<2>();
        const Eigen::Vector2d across(-(b - a).y(), (b - a).x());
        mesh.vertices.col(2).head<2>() = a + across;
        mesh.vertices.col(3).head<2>() = a - across;
        mesh.triangles.resize(3, 2);
        mesh.triangles << 0, 1, 1, 0, 2, 3;
        const Eigen::Vector2d on = a + part(random) * (b - a);
        EXPECT_TRUE(mesh::MeshIndex(mesh).highest(on.x(), on.y()));
    }
}

TEST(MeshIndex, EmptyAndUndefined)
{
    const mesh::Mesh empty{Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xi(3, 0)};
    const mesh::MeshIndex nothing(empty);
    EXPECT_FALSE(nothing.highest(0, 0));
    EXPECT_FALSE(nothing.closest({0, 0, 0}, 1));
    EXPECT_TRUE(nothing.nearby({0, 0, 0}, 1).empty());
    const mesh::Mesh mesh = grid(1);
    const mesh::MeshIndex index(mesh);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(index.closest({nan, 0, 0}, 1));
    EXPECT_TRUE(index.nearby({nan, 0, 0}, 1).empty());
    EXPECT_FALSE(index.highest(nan, 0));
}

// Detail of 1e-4 at coordinates of 1e7: the index works around its own centre.
TEST(MeshIndex, FarFromTheOrigin)
{
    mesh::Mesh mesh = grid(4);
    mesh.vertices *= 1e-4;
    mesh.vertices.colwise() += Eigen::Vector3d(1e7, -1e7, 1e7);
    const mesh::MeshIndex index(mesh);
    const auto found = index.highest(1e7 + 2.5e-4, -1e7 + 1.25e-4);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->point.z(), 1e7 + 1e-4, 1.5e-4);
}

} // namespace mesh_index_test
} // namespace fettle
