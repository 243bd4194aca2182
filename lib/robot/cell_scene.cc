#include "robot/cell_scene.h"

#include "draw/raster.h"
#include "robot/cell.h"
#include "robot/mesh_body.h"

#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

using Eigen::Index, Eigen::Vector3d;

// Directions in which solids are sampled, by azimuth and elevation: odd numbers, so that none is along an axis, where
// all points of a box's face are support points.
constexpr int kAzimuths = 121, kElevations = 61;

/// Triangles with the body that each belongs to.
struct TriangleSoup {
    std::vector<Vector3d> corners; ///< three for each triangle
    std::vector<std::size_t> bodies;

    void add(const Vector3d& a, const Vector3d& b, const Vector3d& c, std::size_t body)
    {
        corners.insert(corners.end(), {a, b, c});
        bodies.push_back(body);
    }
    void add(const mesh::Mesh& mesh, const Eigen::Isometry3d& T, std::size_t body)
    {
        for (const auto t : mesh.triangles.colwise())
            add(T * mesh.vertices.col(t[0]), T * mesh.vertices.col(t[1]), T * mesh.vertices.col(t[2]), body);
    }
};

void add_floor(TriangleSoup& soup, double side, std::size_t body)
{
    Eigen::AlignedBox2d box;
    for (const Vector3d& corner : soup.corners) box.extend(corner.head<2>());
    const Eigen::Array2d min = (box.min().array() / side).floor(), max = (box.max().array() / side).ceil();
    for (double x = min.x(); x < max.x(); ++x)
        for (double y = min.y(); y < max.y(); ++y) {
            const Vector3d a(x * side, y * side, 0), right(side, 0, 0), far(0, side, 0);
            const std::size_t shade = body + (std::fmod(std::abs(x + y), 2) == 0 ? 0 : 1);
            soup.add(a, a + right, a + right + far, shade);
            soup.add(a, a + right + far, a + far, shade);
        }
}

CellScene make_scene(const TriangleSoup& soup)
{
    CellScene scene;
    scene.body = soup.bodies;
    const Index count = soup.corners.size();
    scene.mesh.vertices.resize(3, count);
    scene.mesh.triangles.resize(3, count / 3);
    for (Index i = 0; i < count; ++i) {
        scene.mesh.vertices.col(i) = soup.corners[i];
        scene.mesh.triangles(i % 3, i / 3) = i;
    }
    const Eigen::Matrix3Xd normals = mesh::triangle_normals(scene.mesh);
    for (Index i = 0; i < normals.cols(); ++i) scene.normal.emplace_back(normals.col(i));
    return scene;
}

} // namespace

mesh::Mesh solid_mesh(const Solid& solid)
{
    if (const auto* triangles = std::get_if<solid::Triangles>(&solid)) return triangles->body->mesh;
    const PlacedSolid placed(solid, Eigen::Isometry3d::Identity());
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (kElevations + 1) * kAzimuths);
    for (int u = 0; u <= kElevations; ++u)
        for (int k = 0; k < kAzimuths; ++k) {
            const double up = std::numbers::pi * (double(u) / kElevations - 0.5);
            const double azimuth = 2 * std::numbers::pi * k / kAzimuths;
            const Vector3d direction(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
            mesh.vertices.col(u * kAzimuths + k) = placed.support(direction) + placed.radius() * direction;
        }
    mesh.triangles.resize(3, 2 * kElevations * kAzimuths);
    for (int u = 0, t = 0; u < kElevations; ++u)
        for (int k = 0; k < kAzimuths; ++k) {
            const int a = u * kAzimuths + k, b = u * kAzimuths + (k + 1) % kAzimuths;
            mesh.triangles.col(t++) << a, b, b + kAzimuths;
            mesh.triangles.col(t++) << a, b + kAzimuths, a + kAzimuths;
        }
    return mesh;
}

CellScene make_cell_scene(const Robot& robot, const mesh::Mesh* workpiece, const mesh::Mesh* cuboids,
                          const CellJoints& joints, double floor)
{
    const auto frames = link_frames(robot, Arm(robot), joints);
    TriangleSoup soup;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        const Body& body = robot.bodies[i];
        soup.add(solid_mesh(body.solid), frames[body.link + 1], i);
    }
    if (workpiece != nullptr) soup.add(*workpiece, workpiece_frame(robot, frames), robot.bodies.size());
    if (cuboids != nullptr) soup.add(*cuboids, frames.back(), cuboids_body(robot));
    if (floor > 0) add_floor(soup, floor, floor_body(robot));
    return make_scene(soup);
}

Eigen::ArrayXXi visible_triangles(const CellScene& scene, const Eigen::Matrix3d& rotation_view_cell,
                                  const draw::View& view, Eigen::ArrayXXd& depth)
{
    const mesh::Mesh in_view{rotation_view_cell * scene.mesh.vertices, scene.mesh.triangles};
    Eigen::VectorXd triangle(in_view.vertices.cols()); // by vertex
    for (Index i = 0; i < triangle.size(); ++i) triangle[i] = i / 3;
    const draw::Raster raster = draw::rasterise(view, in_view, triangle);
    depth = raster.depth;
    return raster.covered.select(raster.value.round(), -1).cast<int>();
}

} // namespace fettle::robot
