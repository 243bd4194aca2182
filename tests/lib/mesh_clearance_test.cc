// Distances of meshes from each other: against all pairs of triangles one by one, by code that shares nothing with the
// library's; by hand; and what must hold of any two meshes.

#include "boat_hull.h"
#include "core/constants.h"
#include "cube.h"
#include "draws.h"
#include "irb1400.h"
#include "robot/clearance_tracker.h"
#include "robot/mesh_body.h"
#include "robot/mesh_clearance.h"
#include "robot/urdf.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace fettle {
namespace mesh_clearance_test {

using Eigen::Isometry3d, Eigen::Vector3d;
using robot::kClearanceAccuracy;

double segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1)
{
    const auto to_segment = [](const Vector3d& p, const Vector3d& a, const Vector3d& b) {
        const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        return (a + t * (b - a) - p).norm();
    };
    double least =
        std::min({to_segment(p0, q0, q1), to_segment(p1, q0, q1), to_segment(q0, p0, p1), to_segment(q1, p0, p1)});
    // Where both feet of the common perpendicular lie within.
    Eigen::Matrix<double, 3, 2> directions;
    directions << p1 - p0, q0 - q1;
    const Eigen::Vector2d st = directions.colPivHouseholderQr().solve(q0 - p0);
    if (st.minCoeff() >= 0 && st.maxCoeff() <= 1) least = std::min(least, (directions * st - (q0 - p0)).norm());
    return least;
}

constexpr double kMinArea = 1e-9; // twice; less is a segment

/// The separation of two triangles along an axis, which need not be unit; nothing if it is 0.
double separation(const mesh::Triangle& a, const mesh::Triangle& b, const Vector3d& axis)
{
    if (!(axis.norm() > kMinArea)) return -core::kInfinity;
    const Eigen::RowVector3d on_a = axis.normalized().transpose() * a, on_b = axis.normalized().transpose() * b;
    return std::max(on_b.minCoeff() - on_a.maxCoeff(), on_a.minCoeff() - on_b.maxCoeff());
}

/// The distance of two triangles that are apart; of two that cross the negative overlap along the axis where it is
/// least: the faces of their Minkowski difference are across these axes.
double brute_distance(const mesh::Triangle& a, const mesh::Triangle& b)
{
    const auto edge = [](const mesh::Triangle& t, int k) { return Vector3d(t.col((k + 1) % 3) - t.col(k)); };
    const Vector3d normal_a = edge(a, 0).cross(edge(a, 1)), normal_b = edge(b, 0).cross(edge(b, 1));
    double overlap = std::max(separation(a, b, normal_a), separation(a, b, normal_b)), apart = overlap;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) overlap = std::max(overlap, separation(a, b, edge(a, i).cross(edge(b, j))));
        for (const Vector3d& normal : {normal_a, normal_b})
            apart = std::max(
                {apart, separation(a, b, normal.cross(edge(a, i))), separation(a, b, normal.cross(edge(b, i)))});
    }
    const bool are_segments = normal_a.norm() < kMinArea && normal_b.norm() < kMinArea;
    if (std::max(overlap, apart) <= 0 && !are_segments) return overlap;
    double least = core::kInfinity;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            least = std::min(least, segment_distance(a.col(i), a.col((i + 1) % 3), b.col(j), b.col((j + 1) % 3)));
        least = std::min({least, std::sqrt(mesh::closest_on_triangle(a, b.col(i)).squared_distance),
                          std::sqrt(mesh::closest_on_triangle(b, a.col(i)).squared_distance)});
    }
    return least;
}

double brute_distance(const mesh::Mesh& a, const mesh::Mesh& b, const Isometry3d& T_b_a)
{
    const mesh::Mesh moved{T_b_a * a.vertices, a.triangles};
    double least = core::kInfinity;
    for (Eigen::Index i = 0; i < a.triangles.cols(); ++i)
        for (Eigen::Index j = 0; j < b.triangles.cols(); ++j)
            least = std::min(least, brute_distance(mesh::triangle_of(moved, i), mesh::triangle_of(b, j)));
    return least;
}

class Draw {
  public:
    explicit Draw(unsigned seed) : random_(seed) {}
    double number(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }
    Vector3d vector(double size)
    {
        return Vector3d::NullaryExpr([&] { return number(-size, size); });
    }
    Isometry3d placement(double size)
    {
        std::normal_distribution<double> normal;
        const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([&] { return normal(random_); }).normalized();
        return Eigen::Translation3d(vector(size)) * Eigen::Quaterniond(q);
    }
    /// A closed body with bays: a sphere of triangles whose points are nearer or farther by up to a half.
    mesh::Mesh stone(int rings, double radius)
    {
        const int around = 2 * rings;
        mesh::Mesh mesh;
        mesh.vertices.resize(3, around * (rings - 1) + 2);
        const Eigen::Index top = mesh.vertices.cols() - 1, bottom = top - 1;
        for (int i = 1; i < rings; ++i)
            for (int k = 0; k < around; ++k) {
                const double up = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * k / around;
                mesh.vertices.col(around * (i - 1) + k) =
                    radius * number(0.5, 1) *
                    Vector3d(std::sin(up) * std::cos(turn), std::sin(up) * std::sin(turn), -std::cos(up));
            }
        mesh.vertices.col(bottom) = Vector3d(0, 0, -radius);
        mesh.vertices.col(top) = Vector3d(0, 0, radius);
        std::vector<Eigen::Vector3i> triangles;
        const auto at = [&](int i, int k) {
            return i == 0 ? int(bottom) : i == rings ? int(top) : around * (i - 1) + k % around;
        };
        for (int i = 0; i < rings; ++i)
            for (int k = 0; k < around; ++k) {
                if (i > 0) triangles.emplace_back(at(i, k), at(i, k + 1), at(i + 1, k));
                if (i + 1 < rings) triangles.emplace_back(at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
            }
        mesh.triangles.resize(3, triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(t) = triangles[t];
        return mesh;
    }

  private:
    std::mt19937 random_;
};

double distance(const robot::Workpiece& a, const robot::Workpiece& b, const Isometry3d& T_b_a,
                double max_distance = core::kInfinity)
{
    return robot::nearest_triangles(a, b, T_b_a, max_distance).clearance.distance;
}

TEST(MeshClearance, CubesByHand)
{
    const mesh::Mesh small = cube(1), large = cube(5);
    const robot::Workpiece a(small), b(large);
    const auto at = [](double x, double y, double z) { return Isometry3d(Eigen::Translation3d(x, y, z)); };
    EXPECT_NEAR(distance(a, b, at(8, 0.3, 0.2)), 2, kClearanceAccuracy);                    // face to face
    EXPECT_NEAR(distance(a, b, at(9, 10, 0.2)), 5, kClearanceAccuracy);                     // edge to edge, 3 and 4
    EXPECT_NEAR(distance(a, b, at(7, 8, 12)), std::sqrt(1 + 4 + 36.0), kClearanceAccuracy); // corner to corner
    const Isometry3d turned =
        at(5 + std::numbers::sqrt2 + 0.5, 0.1, 0.2) * Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ());
    EXPECT_NEAR(distance(a, b, turned), 0.5, kClearanceAccuracy); // edge to face
    EXPECT_EQ(distance(a, b, at(8, 0, 0), 1.5), 1.5);             // farther than asked for
    // Wholly inside: 1 from the nearest face, and out through it.
    const robot::NearestTriangles inside = robot::nearest_triangles(a, b, at(3, 0, 0), 50);
    EXPECT_TRUE(inside.inside);
    EXPECT_NEAR(inside.clearance.distance, -3, kClearanceAccuracy);
    EXPECT_NEAR(distance(b, a, at(-3, 0, 0)), -3, kClearanceAccuracy);
    EXPECT_NEAR(distance(a, b, at(0, 0, 0), 0.01), -6, kClearanceAccuracy); // also where nothing is near
    // A face 0.25 deep in the other: the triangles of the sides cross by as much.
    EXPECT_NEAR(distance(a, b, at(5.75, 0.3, 0.2)), -0.25, kClearanceAccuracy);
}

// Bars that cross, no corner of one inside the other: FCL would say that they touch, not how deep.
TEST(MeshClearance, CrossingBars)
{
    mesh::Mesh along = cube(1), across = cube(1);
    along.vertices.row(0) *= 20;
    across.vertices.row(1) *= 20;
    const robot::Workpiece a(along), b(across);
    const auto at = [&](double deep) { return distance(a, b, Isometry3d(Eigen::Translation3d(0, 0, 2 - deep))); };
    for (const double deep : {0.02, 0.4}) EXPECT_NEAR(at(deep), -deep, kClearanceAccuracy) << deep;
    // So deep that each two of their triangles are apart sooner than the bars.
    EXPECT_LT(at(1.5), -0.4);
    EXPECT_GT(at(1.5), -1.5);
}

TEST(MeshClearance, AsByBruteForce)
{
    Draw draw(31);
    int apart = 0, crossing = 0;
    const int count = ::draws(240);
    for (int k = 0; k < count; ++k) {
        const mesh::Mesh of_a = draw.stone(3 + k % 4, 10), of_b = draw.stone(3 + k % 3, k % 3 == 0 ? 60 : 12);
        const robot::Workpiece a(of_a), b(of_b);
        const Isometry3d T = draw.placement(k % 3 == 0 ? 50 : 18);
        const double expected = brute_distance(of_a, of_b, T);
        const robot::NearestTriangles found = robot::nearest_triangles(a, b, T, core::kInfinity);
        if (found.inside) {
            EXPECT_GT(expected, 0);
            EXPECT_LT(found.clearance.distance, -expected + kClearanceAccuracy);
            continue;
        }
        ++(expected > 0 ? apart : crossing);
        EXPECT_NEAR(found.clearance.distance, expected, kClearanceAccuracy) << k;
        // The points said are where they are said to be.
        if (expected > 0) {
            EXPECT_NEAR((found.clearance.on_a - found.clearance.on_b).norm(), expected, kClearanceAccuracy);
            const mesh::Triangle t = T * mesh::triangle_of(of_a, found.triangle_a);
            EXPECT_NEAR(mesh::closest_on_triangle(t, found.clearance.on_a).squared_distance, 0, 1e-9);
        }
        EXPECT_NEAR(distance(b, a, T.inverse()), expected, kClearanceAccuracy);
        for (const double share : {0.5, 0.99, 1.01, 2.0}) {
            const double max = std::abs(expected) * share;
            EXPECT_NEAR(distance(a, b, T, max), std::min(expected, max), kClearanceAccuracy) << k << " " << share;
        }
        const robot::LeafPair start = {std::uint32_t(draw.number(0, 30)), std::uint32_t(draw.number(0, 30))};
        EXPECT_NEAR(robot::nearest_triangles(a, b, T, core::kInfinity, start).clearance.distance, expected,
                    kClearanceAccuracy);
    }
    EXPECT_GT(apart, count / 4);
    EXPECT_GT(crossing, count / 5);
}

// Needles, triangles without area and edges that are parallel but for rounding.
TEST(MeshClearance, Degenerate)
{
    Draw draw(32);
    for (int k = 0; k < ::draws(400); ++k) {
        mesh::Mesh of[2];
        for (mesh::Mesh& mesh : of) {
            mesh.vertices.resize(3, 60);
            mesh.triangles.resize(3, 20);
            for (int t = 0; t < 20; ++t) {
                const Vector3d from = draw.vector(20), along = t % 2 == 0 ? Vector3d(7, 0, 0) : draw.vector(8);
                mesh.vertices.col(3 * t) = from;
                mesh.vertices.col(3 * t + 1) = from + along;
                mesh.vertices.col(3 * t + 2) = from + draw.number(0, 1) * along +
                                               draw.vector(t % 3 == 0   ? 0
                                                           : t % 3 == 1 ? 1e-4
                                                                        : 2);
                mesh.triangles.col(t) << 3 * t, 3 * t + 1, 3 * t + 2;
            }
        }
        const robot::Workpiece a(of[0]), b(of[1]);
        Isometry3d T = Isometry3d::Identity();
        T.translation() = k % 2 == 0 ? draw.vector(30) : draw.vector(3);
        if (k % 3 != 0) T.linear() = Eigen::AngleAxisd(1e-5 * draw.number(-1, 1), Vector3d::UnitZ()).toRotationMatrix();
        EXPECT_NEAR(distance(a, b, T), brute_distance(of[0], of[1], T), kClearanceAccuracy) << k;
    }
}

// No point moved farther than d: the distance changes by no more, in the other as well as outside.
TEST(MeshClearance, ChangesNoMoreThanTheMotion)
{
    Draw draw(33);
    const mesh::Mesh of_a = draw.stone(6, 10), of_b = draw.stone(7, 14);
    const robot::Workpiece a(of_a), b(of_b);
    for (int k = 0; k < ::draws(2000); ++k) {
        const Isometry3d T0 = draw.placement(14);
        const double step = draw.number(0, 2);
        const Isometry3d T1 =
            Eigen::Translation3d(draw.vector(step)) * T0 * Eigen::AngleAxisd(step / 10, draw.vector(1).normalized());
        const robot::NearestTriangles at0 = robot::nearest_triangles(a, b, T0, core::kInfinity),
                                      at1 = robot::nearest_triangles(a, b, T1, core::kInfinity, at0.leaves);
        if (at0.inside || at1.inside) continue;
        const double motion = (T1 * of_a.vertices - T0 * of_a.vertices).colwise().norm().maxCoeff();
        EXPECT_LE(std::abs(at1.clearance.distance - at0.clearance.distance), motion + 2 * kClearanceAccuracy) << k;
    }
}

// A ball on the tool, whose tip is at (1155, 0, 1095) and whose z points along -x, before a cube on the floor of the
// cell, in either order of the bodies: the point said is on the first.
TEST(MeshClearance, BallAndMeshInEitherOrder)
{
    const robot::Body ball{"ball", robot::link::kTool, robot::solid::Sphere{{0, 0, 6}, 6}};
    const robot::Body block{
        "block", robot::link::kCell,
        robot::solid::Triangles{std::make_shared<robot::MeshBody>(cube(10, Vector3d(1205, 0.3, 1095.2)))}};
    for (const bool is_mesh_first : {true, false}) {
        robot::Robot arm = irb1400();
        arm.bodies = {ball, block};
        if (is_mesh_first) std::swap(arm.bodies[0], arm.bodies[1]);
        const robot::Cell cell(arm, nullptr, {});
        ASSERT_EQ(cell.active_pairs().size(), 1u);
        robot::CellState state = cell.place_bodies(robot::CellJoints::Zero());
        cell.measure_clearance(state, cell.active_pairs()[0]);
        const robot::CellClearance& found = state.clearances[cell.active_pairs()[0]];
        EXPECT_NEAR(found.clearance, 40, kClearanceAccuracy);
        EXPECT_LT((found.point - Vector3d(is_mesh_first ? 1195 : 1155, 0, 1095)).norm(), 1e-6)
            << found.point.transpose();
    }
}

// A real arm's meshes over a hull of triangles: hulls and bounds spare measuring, and nothing is lost.
TEST(MeshClearance, AlongAPathAsPairByPair)
{
    const char* samples = std::getenv("SAMPLES");
    const std::string folder = (samples == nullptr ? std::string("samples") : samples) + "/robots/ur5/";
    robot::UrdfOptions urdf;
    urdf.srdf = folder + "ur5.srdf";
    const robot::Robot arm = robot::read_robot(folder + "ur5.urdf", urdf);
    mesh::Mesh hull = boat::hull(2000);
    hull.vertices.colwise() += Vector3d(500, 0, 0);
    const robot::Workpiece workpiece(hull);
    const robot::Cell cell(arm, &workpiece, {});
    robot::ClearanceTracker tracker(cell);
    Draw draw(34);
    robot::CellJoints q = robot::CellJoints::Zero(), speed = q;
    q.head<6>() << 0, -1, 1.5, -1, -1, 0;
    int colliding = 0, of_meshes = 0;
    for (int k = 0; k < 1500; ++k) {
        for (int j = 0; j < 6; ++j) speed[j] = 0.97 * speed[j] + draw.number(-4e-3, 4e-3);
        const robot::CellJoints before = q;
        q += speed;
        const double found = tracker.advance(q).clearance;
        const auto least = [&](const robot::CellJoints& joints) {
            robot::CellState state = cell.place_bodies(joints);
            double min = cell.options().max_clearance;
            for (const std::size_t pair : cell.active_pairs()) {
                cell.measure_clearance(state, pair);
                min = std::min(min, state.clearances[pair].clearance);
            }
            return min;
        };
        EXPECT_NEAR(found, least(q), 2 * kClearanceAccuracy) << k;
        colliding += found < -0.01;
        of_meshes += found > 0 && found < cell.options().max_clearance;
        if (k == 0) continue;
        const double swept = tracker.swept_clearance().clearance;
        for (const double t : {0.3, 0.7})
            if (swept >= -cell.options().tolerance) {
                EXPECT_GE(least(before + t * (q - before)), swept - 2 * kClearanceAccuracy) << k;
            }
    }
    EXPECT_GT(colliding, 50);
    EXPECT_GT(of_meshes, 300);
}

} // namespace mesh_clearance_test
} // namespace fettle
