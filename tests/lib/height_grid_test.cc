#include "boat_hull.h"
#include "cube.h"

#include "core/direction.h"
#include "robot/cuboid_search.h"
#include "robot/heterogeneous.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace fettle {
namespace height_grid_test {

using Eigen::Isometry3d, Eigen::Vector2d, Eigen::Vector3d;

const Isometry3d kHere = Isometry3d::Identity();

mesh::Mesh mesh_of(const std::vector<mesh::Triangle>& triangles)
{
    mesh::Mesh mesh;
    const auto count = static_cast<Eigen::Index>(triangles.size());
    mesh.vertices.resize(3, 3 * count);
    mesh.triangles.resize(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        mesh.vertices.middleCols<3>(3 * i) = triangles[static_cast<std::size_t>(i)];
        mesh.triangles.col(i) << static_cast<int>(3 * i), static_cast<int>(3 * i + 1), static_cast<int>(3 * i + 2);
    }
    return mesh;
}

mesh::Triangle triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
    mesh::Triangle t;
    t << a, b, c;
    return t;
}

// Does no line across x, y or a side of the triangle part it from the cell?
bool meets(const mesh::Triangle& t, const Vector2d& min, double cell)
{
    std::vector<Vector2d> axes = {Vector2d::UnitX(), Vector2d::UnitY()};
    for (int k = 0; k < 3; ++k) axes.push_back((t.col((k + 1) % 3) - t.col(k)).head<2>().unitOrthogonal());
    for (const Vector2d& axis : axes) {
        const Eigen::RowVector3d on = axis.transpose() * t.topRows<2>();
        const double middle = axis.dot(min) + cell * axis.sum() / 2, half = cell * axis.cwiseAbs().sum() / 2;
        if (on.minCoeff() > middle + half || on.maxCoeff() < middle - half) return false;
    }
    return true;
}

// Identities: a rotation, onto the other direction, by no more than the angle between them; nearly opposite ones too.
TEST(Direction, TurnBetween)
{
    std::mt19937 random(5);
    std::normal_distribution<double> any;
    for (int i = 0; i < 400; ++i) {
        const Eigen::Vector3d a(any(random), any(random), any(random));
        const double scale = std::pow(10.0, -(i % 20));
        const Eigen::Vector3d b =
            (i % 2 == 0 ? 3 : -3) * a + scale * Eigen::Vector3d(any(random), any(random), any(random));
        const Eigen::Matrix3d R = core::rotation_between(a, b);
        EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
        EXPECT_GT(R.determinant(), 0);
        EXPECT_LT((R * a.normalized() - b.normalized()).norm(), 3e-12); // what counts as opposite
        const double cosine = a.normalized().dot(b.normalized());
        EXPECT_NEAR((R.trace() - 1) / 2, cosine, 1e-12);
    }
}

// Reference: separating axes, for the cells; points of the triangles, for the heights.
TEST(HeightGrid, EveryCellThatATriangleTouches)
{
    std::mt19937 random(31);
    std::vector<mesh::Triangle> triangles;
    for (int k = 0; k < 200; ++k)
        triangles.push_back(
            mesh::Triangle::NullaryExpr([&] { return std::uniform_real_distribution<double>(0, 30)(random); }));
    for (int k = 0; k < 50; ++k) triangles[k].col(2) = triangles[k].col(1) + Vector3d(1e-3, 2e-3, 5); // needles
    const mesh::Mesh mesh = mesh_of(triangles);
    const robot::HeightGrid grid(mesh, Vector3d::UnitZ(), 1.3, robot::Formulas::corrected);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        mesh::Triangle t;
        for (int k = 0; k < 3; ++k) t.col(k) = grid.T_grid_part * Vector3d(triangles[i].col(k));
        std::vector<std::uint32_t> expected;
        for (Eigen::Index row = 0; row < grid.rows; ++row)
            for (Eigen::Index column = 0; column < grid.columns; ++column)
                if (meets(t, grid.cell_size * Vector2d(column, row), grid.cell_size))
                    expected.push_back(static_cast<std::uint32_t>(grid.index(column, row)));
        std::vector<std::uint32_t> found = grid.triangle_cells[i];
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
        for (int a = 0; a <= 20; ++a)
            for (int b = 0; b <= 20 - a; ++b) {
                const Vector3d p = t * Vector3d(a, b, 20 - a - b) / 20;
                const auto column = static_cast<Eigen::Index>(p.x() / grid.cell_size),
                           row = static_cast<Eigen::Index>(p.y() / grid.cell_size);
                EXPECT_GE(grid.heights[grid.index(column, row)], p.z() - 1e-9);
            }
    }
}

// For any direction: a point's height is its distance along that direction from the lowest point.
TEST(HeightGrid, AcrossAnyDirection)
{
    const mesh::Mesh mesh = boat::hull(2000);
    const Vector3d up = Vector3d(0.3, -0.5, 0.6).normalized();
    const robot::HeightGrid grid(mesh, up, 2, robot::Formulas::corrected);
    const double lowest = (up.transpose() * mesh.vertices).minCoeff();
    for (const auto p : mesh.vertices.colwise())
        EXPECT_NEAR((grid.T_grid_part * Vector3d(p)).z(), up.dot(p) - lowest, 1e-9);
}

// Eq. 12 gives a triangle that contains a corner of one cell none of the cells that only its edges cross: between y
// = 2.1 and 2.9 the tip of this one contains no corner, and a body there goes through it unnoticed.
TEST(HeightGrid, Equation12MissesCellsThatOnlyEdgesCross)
{
    const mesh::Mesh mesh =
        mesh_of({triangle({0, 0, 0}, {30, 0, 0}, {0, 30, 0}), triangle({4.5, 1.5, 9}, {7.5, 1.5, 9}, {6.5, 2.9, 9})});
    const robot::HeightGrid right(mesh, Vector3d::UnitZ(), 1, robot::Formulas::corrected),
        published(mesh, Vector3d::UnitZ(), 1, robot::Formulas::published);
    EXPECT_EQ(right.heights[right.index(6, 2)], 9);
    EXPECT_LT(published.heights[published.index(4, 1)], 9); // its lower left corner lies beside the triangle
    EXPECT_EQ(right.heights[right.index(4, 1)], 9);
    const robot::Workpiece workpiece(mesh);
    const std::vector<Vector3d> ups = {Vector3d::UnitZ()};
    const robot::Solid arm = robot::solid::Sphere{{4.4, 1.4, 9}, 0.3};
    const auto distance = [&](robot::Formulas formulas) {
        const robot::HeterogeneousModel model(workpiece, ups, {1, formulas, 0.01});
        return model.nearest(arm, kHere, {0, std::vector<char>(right.heights.size(), 0)}, 50).clearance.distance;
    };
    EXPECT_LT(distance(robot::Formulas::corrected), -0.01);
    EXPECT_GT(distance(robot::Formulas::published), 0.01);
    EXPECT_LT(workpiece.nearest(robot::PlacedSolid(arm, kHere)).clearance.distance, -0.01);
}

// Eq. 20 rounds to the nearest number: gaps deeper than the tolerance, and no sphere at all for a disc.
TEST(HeightGrid, Equation20LeavesGaps)
{
    constexpr double kTolerance = 0.01;
    const auto gap = [&](const robot::solid::Cylinder& cylinder,
                         robot::Formulas formulas) { // of its side, half-way between two
        const auto row = robot::sphere_row(cylinder, kTolerance, formulas);
        const double half = (row[1].centre - row[0].centre).norm() / 2;
        return cylinder.radius - std::sqrt(cylinder.radius * cylinder.radius - half * half);
    };
    const double spacing = robot::sphere_spacing(45, kTolerance);
    EXPECT_NEAR(45 - std::sqrt(45 * 45 - spacing * spacing / 4), kTolerance,
                1e-12); // eq. 19
    const robot::solid::Cylinder spindle = {{0, 0, 0}, {0, 0, 47.4 * spacing}, 45};
    EXPECT_GT(gap(spindle, robot::Formulas::published), kTolerance + 1e-4);
    EXPECT_LE(gap(spindle, robot::Formulas::corrected), kTolerance);
    const robot::solid::Cylinder disc = {{0, 0, 0}, {0, 0, 0.45 * spacing}, 45};
    EXPECT_TRUE(robot::sphere_row(disc, kTolerance, robot::Formulas::published).empty());
    EXPECT_EQ(robot::sphere_row(disc, kTolerance, robot::Formulas::corrected).size(), 1u);
    // a spike that reaches into the disc
    const mesh::Mesh spike =
        mesh_of({triangle({0, 0, 0}, {90, 0, 0}, {0, 90, 0}), triangle({0, -1, 30}, {0, 1, 30}, {40, 0, 60})});
    const robot::Workpiece workpiece(spike);
    const std::vector<Vector3d> ups = {Vector3d::UnitZ()};
    const Isometry3d T(Eigen::Translation3d(0, 0, 59));
    const auto distance = [&](robot::Formulas formulas) {
        const robot::HeterogeneousModel model(workpiece, ups, {1, formulas, kTolerance});
        const robot::HeightGrid grid(spike, Vector3d::UnitZ(), 1, formulas);
        return model.nearest(disc, T, {0, std::vector<char>(grid.heights.size(), 1)}, 50).clearance.distance;
    };
    EXPECT_LT(distance(robot::Formulas::corrected), -0.1);
    EXPECT_EQ(distance(robot::Formulas::published), 50);
}

// Reference: the farthest points of the cylinder. By eq. 22 what lies under its end is not chosen.
TEST(HeightGrid, Equation22IsTooShort)
{
    const mesh::Mesh floor = mesh_of({triangle({-50, -50, 0}, {250, -50, 0}, {-50, 250, 0})});
    const robot::HeightGrid grid(floor, Vector3d::UnitZ(), 1, robot::Formulas::corrected);
    const double tilt = std::numbers::pi / 6, length = 124, radius = 45;
    const robot::solid::Cylinder spindle = {{0, 0, 0}, {0, 0, length}, radius};
    const Isometry3d T(Eigen::AngleAxisd(tilt, Vector3d::UnitY()));
    const robot::Footprint right = grid.footprint(spindle, T, robot::Formulas::corrected),
                           published = grid.footprint(spindle, T, robot::Formulas::published);
    EXPECT_NEAR(2 * right.half_along, length * std::sin(tilt) + 2 * radius * std::cos(tilt), 1e-9);
    EXPECT_NEAR(2 * right.half_across, 2 * radius, 1e-9);
    EXPECT_NEAR(2 * published.half_along, (length + radius) * std::sin(tilt), 1e-9);
    // a wall under the upper rim: z 82 there is inside the spindle
    const mesh::Mesh wall = mesh_of({triangle({-50, -50, -200}, {250, -50, -200}, {-50, 250, -200}),
                                     triangle({95, -2, 82}, {97, 2, 82}, {96, 0, 20})});
    const robot::Workpiece workpiece(wall);
    robot::Robot robot;
    robot.bodies = {{"spindle", robot::link::kTool, spindle}};
    const auto distance = [&](robot::Formulas formulas) {
        const robot::HeterogeneousModel model(workpiece, std::vector<Vector3d>{Vector3d::UnitZ()}, {1, formulas, 0.01});
        const robot::ToolZone zone = model.tool_zone(robot, T);
        const robot::HeightGrid heights(wall, Vector3d::UnitZ(), 1, formulas);
        const Vector3d foot = heights.T_grid_part * Vector3d(96, 0, 82);
        return std::pair(
            model.nearest(spindle, T, zone, 50).clearance.distance,
            zone.cells[heights.index(static_cast<Eigen::Index>(foot.x()), static_cast<Eigen::Index>(foot.y()))]);
    };
    EXPECT_LT(workpiece.nearest(robot::PlacedSolid(spindle, T)).clearance.distance, -1);
    EXPECT_NEAR(distance(robot::Formulas::corrected).first,
                workpiece.nearest(robot::PlacedSolid(spindle, T)).clearance.distance, 1e-6);
    EXPECT_EQ(distance(robot::Formulas::corrected).second, 1);
    EXPECT_EQ(distance(robot::Formulas::published).second, 0);
}

// Reference: box by box.
TEST(CuboidSearch, AsBoxByBox)
{
    const robot::HeightGrid grid(boat::hull(2000), Vector3d(0.2, -0.1, 1).normalized(), 7, robot::Formulas::corrected);
    const robot::CuboidSearch search(grid);
    std::mt19937 random(5);
    const auto number = [&](double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(random);
    };
    const std::vector<robot::Solid> bodies = {
        robot::solid::Sphere{{0, 0, 0}, 6}, robot::solid::Cylinder{{0, 0, 0}, {0, 0, 90}, 25},
        robot::solid::Cone{{0, 0, 0}, {0, 0, 30}, 12, 25},
        robot::solid::Box{Isometry3d(Eigen::Translation3d(20, 0, 40)), {70, 50, 10}}};
    int deep = 0, none = 0;
    for (int k = 0; k < 400; ++k) {
        const robot::Solid& solid = bodies[static_cast<std::size_t>(k) % bodies.size()];
        Isometry3d T(Eigen::Translation3d(number(-20, 320), number(-20, 140), number(0, 160)));
        T.rotate(Eigen::AngleAxisd(number(-0.6, 0.6), Vector3d(number(-1, 1), number(-1, 1), 0.1).normalized()));
        const robot::PlacedSolid body(solid, T);
        const std::vector<robot::Footprint> areas = {
            grid.footprint(bodies[0], grid.T_grid_part.inverse() * T, robot::Formulas::corrected),
            grid.footprint(bodies[3], grid.T_grid_part.inverse() * T, robot::Formulas::corrected)};
        std::vector<char> left_out(grid.heights.size(), 0);
        if (k % 2 == 0)
            for (const robot::Footprint& area : areas) grid.mark(area, left_out);
        const double max = k % 3 == 0 ? 20 : 500;
        double expected = max;
        for (const std::size_t c : grid.occupied()) {
            if (left_out[c] != 0) continue;
            const Vector3d half = Vector3d(grid.cell_size, grid.cell_size, grid.heights[c]) / 2,
                           min(grid.cell_size * static_cast<double>(c % static_cast<std::size_t>(grid.columns)),
                               grid.cell_size * static_cast<double>(c / static_cast<std::size_t>(grid.columns)), 0);
            const robot::Solid box = robot::solid::Box{Isometry3d(Eigen::Translation3d(min + half)), half};
            expected =
                std::min(expected, robot::clearance(body, robot::PlacedSolid(box, Isometry3d::Identity())).distance);
        }
        const auto found = search.nearest(body, max, left_out, k % 2 == 0 ? areas : std::vector<robot::Footprint>{});
        EXPECT_NEAR(found ? found->distance : max, expected, robot::kClearanceAccuracy) << k;
        deep += expected < 0;
        none += !found;
    }
    EXPECT_GT(deep, 100);
    EXPECT_GT(none, 10);
}

// Deep inside a body neither its triangles nor the cuboids are near: the depth is that of the workpiece itself. By
// hand.
TEST(Heterogeneous, InsideItIsTheWorkpiece)
{
    const mesh::Mesh mesh = cube(50);
    const robot::Workpiece workpiece(mesh);
    const std::vector<Vector3d> up = {Vector3d::UnitZ()};
    const robot::HeterogeneousModel model(workpiece, up, {.cell_size = 10});
    for (const char in_zone : {0, 1}) {
        const robot::ToolZone zone{0, std::vector<char>(100, in_zone)};
        const robot::Solid ball = robot::solid::Sphere{{5, 0, -10}, 5};
        EXPECT_NEAR(model.nearest(ball, kHere, zone, 1000).clearance.distance, -(40 + 5), 1e-6);
    }
}

// A ball-end tool over a hull: the verdicts of the tool are those of the triangles, and no clearance is larger than by
// these, nor smaller by more than what is stated. Leaning poses need more grids than one.
TEST(Heterogeneous, AgreesWithTheTriangles)
{
    const mesh::Mesh mesh = boat::hull(8000);
    const robot::Workpiece workpiece(mesh);
    robot::Robot robot;
    robot.bodies = {{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 0}, 6}},
                    {"shank", robot::link::kTool, robot::solid::Cylinder{{0, 0, 0}, {0, 0, 40}, 5}},
                    {"spindle", robot::link::kTool, robot::solid::Cylinder{{0, 0, 40}, {0, 0, 130}, 45}},
                    {"arm", 6, robot::solid::Capsule{{40, 0, 60}, {200, 0, 80}, 30}}};
    std::vector<Isometry3d> poses = boat::poses(1500);
    std::vector<Vector3d> ups;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        poses[k] = poses[k] * Eigen::AngleAxisd(0.7 * std::sin(0.01 * static_cast<double>(k)), Vector3d::UnitX());
        ups.push_back(poses[k].linear().col(2));
    }
    const robot::HeterogeneousModel model(workpiece, ups, {2, robot::Formulas::corrected, 0.01});
    EXPECT_GT(model.grid_count(), 1u);
    EXPECT_LE(model.grid_count(), 9u);
    int deep = 0;
    for (std::size_t k = 0; k < poses.size(); k += 5) {
        const robot::ToolZone zone = model.tool_zone(robot, poses[k]);
        for (const robot::Body& body : robot.bodies) {
            const double exact = workpiece.nearest(robot::PlacedSolid(body.solid, poses[k]), 50).clearance.distance;
            const double seen = model.nearest(body.solid, poses[k], zone, 50).clearance.distance;
            EXPECT_LE(seen, exact + 1e-6);
            if (body.link != robot::link::kTool) continue;
            EXPECT_EQ(seen < -0.01, exact < -0.01) << body.name << " " << k << " " << seen << " " << exact;
            if (exact < 0) {
                ++deep;
                EXPECT_NEAR(seen, exact, 1e-6);
            }
        }
    }
    EXPECT_GT(deep, 20);
}

} // namespace height_grid_test
} // namespace fettle
