#include "robot/cell_scene.h"

#include "compare/raster.h"
#include "robot/cell.h"

#include <cmath>
#include <numbers>

namespace fettle {

namespace {

using Eigen::Index, Eigen::Vector3d;

// Of the directions in which solids are sampled: odd, so that none lies along an axis, where a box has many points.
constexpr int kAround = 121, kUp = 61;

struct Pieces {
    std::vector<Vector3d> corners; ///< three a triangle
    std::vector<std::size_t> body;

    void add(const Vector3d& a, const Vector3d& b, const Vector3d& c, std::size_t of)
    {
        corners.insert(corners.end(), {a, b, c});
        body.push_back(of);
    }
    void add(const Mesh& mesh, const Eigen::Isometry3d& T, std::size_t of)
    {
        for (const auto t : mesh.triangles.colwise())
            add(T * mesh.vertices.col(t[0]), T * mesh.vertices.col(t[1]), T * mesh.vertices.col(t[2]), of);
    }
};

void add_floor(Pieces& pieces, double side, std::size_t body)
{
    Eigen::AlignedBox2d box;
    for (const Vector3d& corner : pieces.corners) box.extend(corner.head<2>());
    const Eigen::Array2d least = (box.min().array() / side).floor(), most = (box.max().array() / side).ceil();
    for (double x = least.x(); x < most.x(); ++x)
        for (double y = least.y(); y < most.y(); ++y) {
            const Vector3d a(x * side, y * side, 0), right(side, 0, 0), far(0, side, 0);
            const std::size_t shade = body + (std::fmod(std::abs(x + y), 2) == 0 ? 0 : 1);
            pieces.add(a, a + right, a + right + far, shade);
            pieces.add(a, a + right + far, a + far, shade);
        }
}

CellScene scene_of(const Pieces& pieces)
{
    CellScene scene;
    scene.body = pieces.body;
    const auto count = static_cast<Index>(pieces.corners.size());
    scene.mesh.vertices.resize(3, count);
    scene.mesh.triangles.resize(3, count / 3);
    for (Index i = 0; i < count; ++i) {
        scene.mesh.vertices.col(i) = pieces.corners[static_cast<std::size_t>(i)];
        scene.mesh.triangles(i % 3, i / 3) = static_cast<int>(i);
    }
    const Eigen::Matrix3Xd normals = triangle_normals(scene.mesh);
    for (Index i = 0; i < normals.cols(); ++i) scene.normal.emplace_back(normals.col(i));
    return scene;
}

} // namespace

Mesh solid_mesh(const Solid& solid)
{
    const PlacedSolid placed(solid, Eigen::Isometry3d::Identity());
    Mesh mesh;
    mesh.vertices.resize(3, (kUp + 1) * kAround);
    for (int u = 0; u <= kUp; ++u)
        for (int k = 0; k < kAround; ++k) {
            const double up = std::numbers::pi * (double(u) / kUp - 0.5);
            const double azimuth = 2 * std::numbers::pi * k / kAround;
            const Vector3d direction(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
            mesh.vertices.col(u * kAround + k) = placed.farthest(direction) + placed.radius() * direction;
        }
    mesh.triangles.resize(3, 2 * kUp * kAround);
    for (int u = 0, t = 0; u < kUp; ++u)
        for (int k = 0; k < kAround; ++k) {
            const int a = u * kAround + k, b = u * kAround + (k + 1) % kAround;
            mesh.triangles.col(t++) << a, b, b + kAround;
            mesh.triangles.col(t++) << a, b + kAround, a + kAround;
        }
    return mesh;
}

CellScene cell_scene(const Robot& robot, const Mesh* workpiece, const Mesh* cuboids, const CellJoints& joints,
                     double floor)
{
    const auto frames = link_frames(robot, Arm(robot), joints);
    Pieces pieces;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        const Body& body = robot.bodies[i];
        pieces.add(solid_mesh(body.solid), frames[static_cast<std::size_t>(body.link + 1)], i);
    }
    if (workpiece != nullptr) pieces.add(*workpiece, frames.back(), robot.bodies.size());
    if (cuboids != nullptr) pieces.add(*cuboids, frames.back(), cuboids_body(robot));
    if (floor > 0) add_floor(pieces, floor, floor_body(robot));
    return scene_of(pieces);
}

Eigen::ArrayXXi seen_triangles(const CellScene& scene, const Eigen::Matrix3d& rotation_view_cell, const View& view,
                               Eigen::ArrayXXd& depth)
{
    const Mesh seen{rotation_view_cell * scene.mesh.vertices, scene.mesh.triangles};
    Eigen::VectorXd number(seen.vertices.cols());
    for (Index i = 0; i < number.size(); ++i) number[i] = static_cast<double>(i / 3);
    const Raster raster = rasterise(view, seen, number);
    depth = raster.depth;
    return raster.covered.select(raster.value.round(), -1).cast<int>();
}

} // namespace fettle
