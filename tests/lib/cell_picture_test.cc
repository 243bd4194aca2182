// Pictures of a cell. References: volumes, distances, and what lies before what by construction.
#include "core/error.h"
#include "cube.h"
#include "irb1400.h"
#include "robot/cell_picture.h"
#include "robot/cell_scene.h"
#include "robot/clearance.h"
#include "robot/collision.h"
#include "robot/heterogeneous.h"
#include "robot/mesh_body.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace fettle {

namespace cell_picture_test {

using Eigen::Isometry3d, Eigen::Vector3d;

double volume(const mesh::Mesh& mesh)
{
    double sum = 0;
    for (const auto t : mesh.triangles.colwise()) {
        const Vector3d a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]);
        sum += a.dot(b.cross(c)) / 6;
    }
    return sum;
}

TEST(CellScene, MeshesOfSolidsHaveTheirVolumes)
{
    const double pi = std::numbers::pi;
    Isometry3d turned(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    turned.translation() << 5, -3, 2;
    Eigen::Matrix3Xd corners(3, 4);
    corners << 0, 6, 0, 0, 0, 0, 6, 0, 0, 0, 0, 6;
    const std::vector<std::pair<robot::Solid, double>> solids = {
        {robot::solid::Sphere{{1, 2, 3}, 10}, 4000 * pi / 3},
        {robot::solid::Capsule{{0, 0, 0}, {0, 30, 0}, 10}, 4000 * pi / 3 + 3000 * pi},
        {robot::solid::Cylinder{{0, 0, 0}, {0, 12, 16}, 10}, 2000 * pi},
        {robot::solid::Cone{{0, 0, 0}, {30, 0, 0}, 10, 4}, 10 * pi * (100 + 40 + 16)},
        {robot::solid::Box{turned, {5, 10, 15}}, 6000},
        {robot::solid::Hull{corners}, 36}};
    for (const auto& [solid, expected] : solids) {
        const mesh::Mesh mesh = robot::solid_mesh(solid);
        EXPECT_NEAR(volume(mesh), expected, 4e-3 * expected) << solid.index();
        const robot::PlacedSolid placed(solid, Isometry3d::Identity());
        for (const auto& p : mesh.vertices.colwise()) EXPECT_NEAR(placed.signed_distance(p).value, 0, 1e-9);
    }
}

TEST(CellScene, MeshesOfLinksAreDrawnAsTheyAre)
{
    const mesh::Mesh hollow = cube(40);
    const mesh::Mesh drawn = robot::solid_mesh(robot::solid::Triangles{std::make_shared<robot::MeshBody>(hollow)});
    EXPECT_EQ(drawn.vertices, hollow.vertices);
    EXPECT_EQ(drawn.triangles, hollow.triangles);
}

// A small box before a large one, seen along -x.
TEST(CellScene, WhatIsNearerIsSeen)
{
    robot::Robot robot = irb1400();
    const auto box = [](const Vector3d& at, double half) {
        return robot::solid::Box{Isometry3d(Eigen::Translation3d(at)), Vector3d::Constant(half)};
    };
    robot.bodies = {{"behind", robot::link::kCell, box({0, 0, 0}, 50)},
                    {"before", robot::link::kCell, box({100, 0, 0}, 10)}};
    const robot::CellScene scene = robot::make_cell_scene(robot, nullptr, nullptr, robot::CellJoints::Zero(), 0);
    const draw::View view{{-75, -75}, 1, 150, 150};
    Eigen::ArrayXXd depth;
    const Eigen::ArrayXXi seen = robot::visible_triangles(scene, draw::view_rotation(Vector3d::UnitX()), view, depth);
    int pixels[3] = {0, 0, 0};
    for (int i = 0; i < seen.size(); ++i) ++pixels[seen(i) < 0 ? 2 : scene.body[static_cast<std::size_t>(seen(i))]];
    EXPECT_EQ(pixels[1], 20 * 20);
    EXPECT_EQ(pixels[0], 100 * 100 - 20 * 20);
    EXPECT_EQ(pixels[2], 150 * 150 - 100 * 100);
    EXPECT_NEAR(depth(75, 75), 110, 1e-9);
    EXPECT_NEAR(depth(45, 45), 50, 1e-9);
}

TEST(CellScene, TheWorkpieceTurnsWithTheTable)
{
    robot::Robot robot = irb1400();
    robot.table = robot::Table{{100, 0, 0}, Vector3d::UnitZ(), {-4, 4}, {}, ""};
    mesh::Mesh part;
    part.vertices.resize(3, 3);
    part.vertices << 110, 120, 110, 0, 0, 5, 7, 7, 7;
    part.triangles = Eigen::Vector3i(0, 1, 2);
    robot::CellJoints q = robot::CellJoints::Zero();
    q[7] = std::numbers::pi / 2;
    const robot::CellScene scene = robot::make_cell_scene(robot, &part, nullptr, q, 0);
    Eigen::Matrix3d expected;
    expected << 100, 100, 95, 10, 20, 10, 7, 7, 7;
    EXPECT_LT((scene.mesh.vertices - expected).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(scene.body, std::vector<std::size_t>{0}); // it has no bodies: the workpiece is number 0
}

// Two triangles over 3 x 2 cells: below the tool the triangles count, elsewhere the cuboids.
TEST(CellScene, AModelIsDrawnAsItCounts)
{
    mesh::Mesh roof;
    roof.vertices.resize(3, 4);
    roof.vertices << 0, 29, 29, 0, 0, 0, 19, 19, 5, 8, 8, 5;
    roof.triangles.resize(3, 2);
    roof.triangles << 0, 0, 1, 2, 2, 3;
    const robot::Workpiece workpiece(roof);
    const std::vector<Vector3d> up = {Vector3d::UnitZ()};
    const robot::HeterogeneousModel model(workpiece, up, {.cell_size = 10});
    robot::ToolZone zone{0, std::vector<char>(6, 0)};
    robot::HeterogeneousModel::Geometry parts = model.geometry(zone);
    EXPECT_EQ(parts.triangles.triangles.cols(), 0);
    ASSERT_EQ(parts.cuboids.triangles.cols(), 6 * 12);
    // They begin at the lowest point, and each is as high as the roof over it: 5 + 3 (x / 29) at its far side.
    double expected = 0;
    constexpr double kTouched = 1e-6; // cells reach a nanometre beyond their sides, over 600 mm²
    for (const double far : {10.0, 20.0, 29.0}) expected += 2 * 100 * 3 * far / 29;
    EXPECT_NEAR(volume(parts.cuboids), expected, kTouched);
    zone.cells[2] = 1; // the corner at x 29, y 0, where only the first triangle lies
    parts = model.geometry(zone);
    EXPECT_EQ(parts.triangles.triangles, Eigen::Matrix3Xi(roof.triangles.leftCols(1)));
    EXPECT_EQ(parts.cuboids.triangles.cols(), 5 * 12);
    EXPECT_NEAR(volume(parts.cuboids), expected - 300, kTouched);
    std::fill(zone.cells.begin(), zone.cells.end(), char{1});
    parts = model.geometry(zone);
    EXPECT_EQ(parts.triangles.triangles, roof.triangles);
    EXPECT_EQ(parts.cuboids.triangles.cols(), 0);
}

using Colour = std::array<png_byte, 3>;

// The pixels of a picture, row by row.
struct Pixels {
    std::vector<Colour> above_legend, legend;
};

Pixels decode(const std::string& picture)
{
    constexpr std::size_t kLegendRows = 34;
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, picture.data(), picture.size()), 0) << image.message;
    image.format = PNG_FORMAT_RGB;
    std::vector<Colour> all(std::size_t(image.width) * image.height);
    EXPECT_NE(png_image_finish_read(&image, nullptr, all.data(), 0, nullptr), 0) << image.message;
    const auto split = all.end() - std::ptrdiff_t(kLegendRows * image.width);
    return {{all.begin(), split}, {split, all.end()}};
}

// A box and a slope, and what counts of them beside the tool: cuboids in their colour, and of the slope a step. What
// they are AModelIsDrawnAsItCounts tests.
TEST(CellPicture, ShowsTheModel)
{
    robot::Robot robot = irb1400();
    robot.bodies = {{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 6}, 6}}};
    const robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 1);
    const Vector3d tip =
        robot::link_frames(robot, robot::Arm(robot), joints.col(0))[robot::link::kTool + 1].translation();
    const auto part = [&](double low) {
        mesh::Mesh box = cube(1);
        for (int k = 0; k < 8; ++k)
            box.vertices.col(k) << tip.x() + (k & 1 ? 200 : 100), tip.y() + (k & 2 ? 50 : -50),
                (k & 4 ? tip.z() - (k & 1 ? low : 0) : tip.z() - 300);
        return box;
    };
    std::set<std::vector<Colour>> pictures;
    for (const double low : {0.0, 150.0}) {
        const mesh::Mesh mesh = part(low);
        const robot::Workpiece workpiece(mesh);
        const std::vector<Vector3d> up = {Vector3d::UnitZ()};
        const robot::HeterogeneousModel model(workpiece, up, {.cell_size = 100});
        const robot::CheckedPath checked = robot::check_path(robot, nullptr, joints, {});
        robot::CellPictureOptions options;
        options.poses = {0};
        const std::string plain = robot::draw_cell_picture(robot, &mesh, joints, checked, options);
        options.model = &model;
        const std::string drawn = robot::draw_cell_picture(robot, &mesh, joints, checked, options);
        pictures.insert(decode(plain).above_legend);
        pictures.insert(decode(drawn).above_legend);
        EXPECT_EQ(robot::draw_cell_picture(robot, &mesh, joints, checked, options), drawn);
    }
    EXPECT_EQ(pictures.size(), 4u);
}

TEST(CellPicture, NamesInItsLegendWhatIsDrawn)
{
    const Colour part = {198, 176, 130}, cuboids = {226, 218, 196}, collides = {200, 30, 40};
    robot::Robot robot = irb1400();
    robot.bodies = {{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 6}, 6}}};
    const robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 1);
    robot::CheckedPath checked = robot::check_path(robot, nullptr, joints, {});
    robot::CellPictureOptions options;
    options.poses = {0};
    const mesh::Mesh box = cube(1);
    const auto named = [&](const mesh::Mesh* workpiece) {
        const std::vector<Colour> legend =
            decode(robot::draw_cell_picture(robot, workpiece, joints, checked, options)).legend;
        std::vector<Colour> found;
        for (const Colour& colour : {part, cuboids, collides})
            if (std::ranges::find(legend, colour) != legend.end()) found.push_back(colour);
        return found;
    };
    EXPECT_EQ(named(nullptr), std::vector<Colour>());
    EXPECT_EQ(named(&box), std::vector<Colour>({part}));
    const robot::Workpiece workpiece(box);
    const std::vector<Vector3d> up = {Vector3d::UnitZ()};
    const robot::HeterogeneousModel model(workpiece, up, {.cell_size = 100});
    options.model = &model;
    EXPECT_EQ(named(&box), std::vector<Colour>({part, cuboids}));
    checked.at_poses[0].clearance = -1;
    EXPECT_EQ(named(&box), std::vector<Colour>({part, cuboids, collides}));
}

TEST(CellPicture, RefusesPosesThatAreNotThere)
{
    robot::Robot robot = irb1400();
    robot.bodies = {{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 6}, 6}}};
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 2);
    joints.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
    const robot::CheckedPath checked = robot::check_path(robot, nullptr, joints, {});
    robot::CellPictureOptions options;
    options.poses = {0};
    const std::string png = robot::draw_cell_picture(robot, nullptr, joints, checked, options);
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(robot::draw_cell_picture(robot, nullptr, joints, checked, options), png);
    options.poses = {1};
    EXPECT_THROW(robot::draw_cell_picture(robot, nullptr, joints, checked, options), core::InputError);
    options.poses = {2};
    EXPECT_THROW(robot::draw_cell_picture(robot, nullptr, joints, checked, options), core::InputError);
}

} // namespace cell_picture_test

} // namespace fettle
