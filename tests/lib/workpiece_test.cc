#include "boat_hull.h"
#include "brute_force.h"
#include "mesh/closed.h"
#include "robot/workpiece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fettle {
namespace workpiece_test {

using Eigen::Isometry3d, Eigen::Vector3d;

// A sheet z = 5 sin(x / 9) cos(y / 7) over a square; with a floor and walls it is a body.
double height(double x, double y) { return 5 * std::sin(x / 9) * std::cos(y / 7); }

mesh::Mesh sheet(int cells, double side)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (cells + 1) * (cells + 1));
    mesh.triangles.resize(3, 2 * cells * cells);
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const double x = side * i / cells - side / 2, y = side * j / cells - side / 2;
            mesh.vertices.col(j * (cells + 1) + i) << x, y, height(x, y);
        }
    Eigen::Index t = 0;
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
            mesh.triangles.col(t++) << a, b, d;
            mesh.triangles.col(t++) << a, d, c;
        }
    return mesh;
}

mesh::Mesh cube(double side)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8);
    for (int k = 0; k < 8; ++k)
        mesh.vertices.col(k) << (k & 1 ? side : -side) / 2, (k & 2 ? side : -side) / 2, (k & 4 ? side : -side) / 2;
    mesh.triangles.resize(3, 12);
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int f = 0; f < 6; ++f) {
        mesh.triangles.col(2 * f) << faces[f][0], faces[f][1], faces[f][2];
        mesh.triangles.col(2 * f + 1) << faces[f][0], faces[f][2], faces[f][3];
    }
    return mesh;
}

// The smallest distance of points of a triangle, 40 along each side.
double deepest(const robot::PlacedSolid& body, const mesh::Triangle& t)
{
    double min = INFINITY;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40 - i; ++j)
            min =
                std::min(min, body.signed_distance((i * t.col(0) + j * t.col(1) + (40 - i - j) * t.col(2)) / 40).value);
    return min;
}

// Reference: every triangle, one by one.
TEST(Workpiece, NearestAsByBruteForce)
{
    const mesh::Mesh mesh = sheet(24, 100);
    const robot::Workpiece workpiece(mesh);
    EXPECT_FALSE(workpiece.closed());
    std::mt19937 random(11);
    const auto number = [&](double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random);
    };
    int touching = 0;
    double max_slack = 0; // of the lower bounds, mm
    for (int k = 0; k < 600; ++k) {
        const Vector3d at(number(-70, 70), number(-70, 70), number(-15, 30));
        const Vector3d to = at + Vector3d(number(-20, 20), number(-20, 20), number(1, 40));
        const robot::Solid solid = k % 3 == 0   ? robot::Solid(robot::solid::Sphere{at, number(1, 8)})
                                   : k % 3 == 1 ? robot::Solid(robot::solid::Cylinder{at, to, number(1, 15)})
                                                : robot::Solid(robot::solid::Cone{at, to, number(0, 5), number(5, 20)});
        const robot::PlacedSolid body(solid, Isometry3d::Identity());
        double min = INFINITY;
        for (const auto t : mesh.triangles.colwise()) {
            mesh::Triangle corners;
            for (int i = 0; i < 3; ++i) corners.col(i) = mesh.vertices.col(t[i]);
            const double separation = robot::clearance(body, robot::PlacedSolid(corners)).distance;
            min = std::min(min, separation > 0 ? separation : deepest(body, corners));
        }
        const robot::Workpiece::Nearest found = workpiece.nearest(body);
        const double tolerance = min > 0 ? 2 * robot::kClearanceAccuracy : 0.1; // depths: of points 0.15 mm apart
        EXPECT_NEAR(found.clearance.distance, min, tolerance);
        EXPECT_LE(found.clearance.distance, min + 1e-3); // none of them is deeper
        EXPECT_GE(found.triangle, 0);
        const robot::Workpiece::Nearest near = workpiece.nearest(body, 3);
        EXPECT_NEAR(near.clearance.distance, std::min(min, 3.0), tolerance);
        EXPECT_EQ(near.triangle >= 0, min < 3);
        const double lower = workpiece.lower_bound(body, 3, near.leaf).distance;
        EXPECT_LE(lower, near.clearance.distance + 1e-9);
        if (min > 0) max_slack = std::max(max_slack, near.clearance.distance - lower);
        if (min < 0) ++touching;
    }
    EXPECT_GT(touching, 100);
    EXPECT_LT(touching, 500);
    EXPECT_LT(max_slack, 4); // mm, the side of a triangle: a cylinder's rim may bend as sharply
}

// A damaged file, of which one corner is as far as the moon. Reference: all triangles, in double.
TEST(Workpiece, ACornerFarOffDisturbsNoBall)
{
    mesh::Mesh mesh = sheet(24, 100);
    mesh.vertices.col(24) << 3.84e8, -1e8, -2e8;
    const robot::Workpiece workpiece(mesh);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> place(-60, 60);
    for (int k = 0; k < 200; ++k) {
        const Vector3d at(place(random), place(random), place(random) / 3);
        const robot::PlacedSolid ball(robot::solid::Sphere{at, 2}, Isometry3d::Identity());
        double min = INFINITY, min_near = INFINITY; // of all, and of those without that corner
        for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
            const double squared = mesh::closest_on_triangle(mesh::triangle_of(mesh, t), at).squared_distance;
            min = std::min(min, squared);
            if ((mesh.triangles.col(t).array() != 24).all()) min_near = std::min(min_near, squared);
        }
        EXPECT_LE(workpiece.lower_bound(ball, 50, 0).distance, std::sqrt(min) - 2);
        if (min < min_near) continue; // the far triangles themselves are rough, in double too
        EXPECT_NEAR(workpiece.nearest(ball).clearance.distance, std::sqrt(min) - 2, 1e-9);
    }
}

// A box by its corners. Reference: the box.
TEST(Workpiece, AHullIsMetAsItsBox)
{
    const mesh::Mesh mesh = sheet(24, 100);
    const robot::Workpiece workpiece(mesh);
    std::mt19937 random(17);
    std::uniform_real_distribution<double> place(-60, 60), height_over(-12, 30);
    const Vector3d half(9, 6, 4);
    robot::solid::Hull hull{Eigen::Matrix3Xd(3, 8)};
    for (int k = 0; k < 8; ++k)
        hull.points.col(k) << (k & 1 ? 1 : -1) * half.x(), (k & 2 ? 1 : -1) * half.y(), (k & 4 ? 1 : -1) * half.z();
    const robot::Solid box = robot::solid::Box{Isometry3d::Identity(), half}, same = hull;
    int touching = 0;
    for (int k = 0; k < 200; ++k) {
        Isometry3d T(Eigen::AngleAxisd(k, Vector3d(1, 2, 3).normalized()));
        T.pretranslate(Vector3d(place(random), place(random), height_over(random)));
        const double expected = workpiece.nearest(robot::PlacedSolid(box, T)).clearance.distance;
        EXPECT_NEAR(workpiece.nearest(robot::PlacedSolid(same, T)).clearance.distance, expected, 1e-3);
        touching += expected < 0;
    }
    EXPECT_GT(touching, 20);
    EXPECT_LT(touching, 180);
}

// A tool along a raster over a hull, its ball just clear or 0.05 mm too deep, its spindle now and then in the hull.
// Reference: each triangle clipped by each part. tool_hull_bench does the same with 50,000 poses and 100,000 triangles.
TEST(Workpiece, VerdictsAsByBruteForce)
{
    constexpr double kTolerance = 0.01;
    const mesh::Mesh mesh = boat::hull(20000);
    const robot::Workpiece workpiece(mesh);
    const robot::Solid tool[] = {robot::solid::Sphere{{0, 0, 0}, 6}, robot::solid::Cylinder{{0, 0, 0}, {0, 0, 40}, 5},
                                 robot::solid::Cylinder{{0, 0, 40}, {0, 0, 130}, 45}};
    int deeper = 0, clear = 0;
    for (const Isometry3d& T : boat::poses(1500))
        for (const robot::Solid& part : tool) {
            const double clearance = workpiece.nearest(robot::PlacedSolid(part, T), 50).clearance.distance;
            const bool deep = any_deeper(mesh, part, T, kTolerance);
            if (std::abs(clearance + kTolerance) > robot::kClearanceAccuracy) {
                EXPECT_EQ(clearance < -kTolerance, deep);
            }
            ++(deep ? deeper : clear);
        }
    EXPECT_GT(deeper, 100);
    EXPECT_GT(clear, 1000);
}

// Where a search begins changes nothing.
TEST(Workpiece, BeginsAnywhere)
{
    const mesh::Mesh mesh = sheet(40, 100);
    const robot::Workpiece workpiece(mesh);
    std::mt19937 random(13);
    for (int k = 0; k < 300; ++k) {
        const Vector3d at = Vector3d::NullaryExpr([&] { return std::uniform_real_distribution(-40.0, 40.0)(random); });
        const robot::Solid solid =
            k % 2 == 0 ? robot::Solid(robot::solid::Cylinder{at, at + Vector3d(3, 8, 20), 7})
                       : robot::Solid(robot::solid::Box{Isometry3d(Eigen::Translation3d(at)), {9, 6, 4}});
        const robot::PlacedSolid body(solid, Isometry3d::Identity());
        const double min = workpiece.nearest(body).clearance.distance;
        for (const std::uint32_t leaf : {7u, 211u, 399u, 100000u})
            EXPECT_NEAR(workpiece.nearest(body, 1000, leaf).clearance.distance, min, k % 2 == 0 ? 1e-6 : 1e-3);
    }
}

TEST(Workpiece, BallOnAPlane)
{
    const mesh::Mesh mesh = cube(100);
    const robot::Workpiece workpiece(mesh);
    EXPECT_TRUE(workpiece.closed());
    const auto gap = [&](double z) {
        const robot::Solid ball = robot::solid::Sphere{{10, 5, z}, 6};
        return workpiece.nearest(robot::PlacedSolid(ball, Isometry3d::Identity()));
    };
    EXPECT_NEAR(gap(57).clearance.distance, 1, 1e-8);
    EXPECT_NEAR(gap(56).clearance.distance, 0, 1e-8);
    EXPECT_NEAR(gap(55.95).clearance.distance, -0.05, 1e-8);
    EXPECT_NEAR((gap(57).clearance.on_b - Vector3d(10, 5, 50)).norm(), 0, 1e-6);
    // wholly inside, no triangle is touched: out of it are 30 for the centre and the radius; so it is half-way in
    EXPECT_TRUE(gap(20).inside);
    EXPECT_NEAR(gap(20).clearance.distance, -36, 1e-8);
    EXPECT_NEAR((gap(20).clearance.on_a - Vector3d(10, 5, 14)).norm(), 0, 1e-6);
    EXPECT_NEAR(gap(51).clearance.distance, -5, 1e-8);
    EXPECT_NEAR(gap(49).clearance.distance, -7, 1e-8);
    EXPECT_FALSE(gap(57).inside);
    const robot::Solid ball = robot::solid::Sphere{{10, 20, 20}, 6};
    EXPECT_NEAR(workpiece.nearest(robot::PlacedSolid(ball, Isometry3d::Identity()), 2).clearance.distance, -36, 1e-8);
    // in a pocket of the box around the mesh, but outside the metal
    mesh::Mesh wedge = mesh;
    wedge.vertices(2, 6) = wedge.vertices(2, 7) = -49; // two corners of the top pressed down: a slope
    const robot::Solid small = robot::solid::Sphere{{0, 30, 30}, 1};
    const robot::Workpiece::Nearest over =
        robot::Workpiece(wedge).nearest(robot::PlacedSolid(small, Isometry3d::Identity()));
    EXPECT_FALSE(over.inside);
    EXPECT_GT(over.clearance.distance, 1);
    // a hole in the mesh: it has no inside
    mesh::Mesh open = mesh;
    open.triangles.conservativeResize(3, 11);
    EXPECT_FALSE(mesh::is_closed(open));
    EXPECT_FALSE(robot::Workpiece(open).nearest(robot::PlacedSolid(ball, Isometry3d::Identity())).inside);
}

// A cell crossed only by an edge of a long needle, corners far away: it is found all the same.
TEST(Workpiece, NeedlesAreNotMissed)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 3);
    mesh.vertices << -1000, 1000, 1000, 0, 0.01, -0.01, 0, 0, 0;
    mesh.triangles = Eigen::Vector3i(0, 1, 2);
    const robot::Workpiece workpiece(mesh);
    const robot::Solid ball = robot::solid::Sphere{{3, 0, 7}, 6};
    EXPECT_NEAR(workpiece.nearest(robot::PlacedSolid(ball, Isometry3d::Identity())).clearance.distance, 1, 1e-8);
}

} // namespace workpiece_test
} // namespace fettle
