#include "cloud/profiles.h"
#include "core/constants.h"
#include "core/error.h"
#include "geometry/uniform_draws.h"
#include "reconstruct/reconstruct.h"
#include "reconstruct/triangle_sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace fettle {
namespace reconstruct_test {

using reconstruct::Reconstruction;

/// Points scattered evenly at random; `point(u, v)` maps two uniform numbers onto the surface.
cloud::Cloud scattered(int count, std::uint64_t seed, const std::function<Eigen::Vector3d(double, double)>& point)
{
    std::mt19937_64 random(seed);
    cloud::Cloud cloud;
    cloud.xyz.resize(3, count);
    for (int i = 0; i < count; ++i) {
        const double u = geometry::draw_uniform(random), v = geometry::draw_uniform(random);
        cloud.xyz.col(i) = point(u, v);
    }
    return cloud;
}

Eigen::Vector3d on_sphere(double u, double v)
{
    const double z = 2 * u - 1, across = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * v;
    return 50 * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), z) + Eigen::Vector3d(1e4, 0, -300);
}

/// Largest distance of the middles of triangles and edges from the surface, mm.
double max_error(const mesh::CloudMesh& part, const std::function<double(const Eigen::Vector3d&)>& distance)
{
    double error = 0;
    for (const auto& corners : part.triangles.colwise()) {
        const Eigen::Matrix3d p = part.points.xyz(Eigen::all, corners);
        error = std::max(error, std::abs(distance(p.rowwise().mean())));
        for (int k = 0; k < 3; ++k) error = std::max(error, std::abs(distance((p.col(k) + p.col((k + 1) % 3)) / 2)));
    }
    return error;
}

double area(const mesh::CloudMesh& part)
{
    double sum = 0;
    for (const auto& c : part.triangles.colwise()) {
        const Eigen::Matrix3d p = part.points.xyz(Eigen::all, c);
        sum += (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2;
    }
    return sum;
}

/// Volume inside; positive if the triangles face outward.
double volume(const mesh::CloudMesh& part)
{
    double sum = 0;
    const Eigen::Vector3d middle = part.points.xyz.rowwise().mean();
    for (const auto& c : part.triangles.colwise()) {
        const Eigen::Matrix3d p = part.points.xyz(Eigen::all, c).colwise() - middle;
        sum += p.determinant() / 6;
    }
    return sum;
}

double longest_edge(const mesh::CloudMesh& part)
{
    double longest = 0;
    for (const auto& c : part.triangles.colwise())
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (part.points.xyz.col(c[k]) - part.points.xyz.col(c[(k + 1) % 3])).norm());
    return longest;
}

/// Each edge belongs to one triangle in each direction at most.
void expect_orientable(const mesh::CloudMesh& part)
{
    std::map<std::pair<int, int>, int> edges;
    for (const auto& c : part.triangles.colwise())
        for (int k = 0; k < 3; ++k) ++edges[{c[k], c[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) EXPECT_EQ(count, 1) << edge.first << ' ' << edge.second;
}

TEST(Reconstruct, ScatteredSphereIsClosedAndFacesOutward)
{
    reconstruct::ReconstructRequest request;
    request.max_gap = 8; // 6 mean spacings: random points leave gaps of five
    const Reconstruction result = reconstruct::reconstruct(scattered(20000, 1, on_sphere), request);
    expect_orientable(result.mesh);
    EXPECT_EQ(result.order, "none");
    EXPECT_LE(result.borders, 3);
    EXPECT_LE(result.left_out, 20000 / 500);
    EXPECT_LE(longest_edge(result.mesh), result.max_gap);
    // The sagitta of the longest chord.
    const double bound = result.max_gap * result.max_gap / (8 * 50.0);
    EXPECT_LE(max_error(result.mesh,
                        [](const Eigen::Vector3d& p) { return (p - Eigen::Vector3d(1e4, 0, -300)).norm() - 50; }),
              1.4 * bound);
    const double ball = 4 * std::numbers::pi * std::pow(50, 3) / 3, sphere = 4 * std::numbers::pi * 2500;
    EXPECT_NEAR(volume(result.mesh) / ball, 1, 2e-3);
    EXPECT_NEAR(area(result.mesh) / sphere, 1, 2e-3);
}

TEST(Reconstruct, TorusAndOpenCylinder)
{
    // On the torus, u is drawn anew until the density is even: by the inverse of the angle's distribution, solved once.
    const auto on_torus = [](double u, double v) {
        double angle = 2 * std::numbers::pi * u;
        for (int k = 0; k < 20; ++k) // u = (angle + (r / R) sin angle) / 2π
            angle -= (angle + 0.4 * std::sin(angle) - 2 * std::numbers::pi * u) / (1 + 0.4 * std::cos(angle));
        const double turn = 2 * std::numbers::pi * v, across = 50 + 20 * std::cos(angle);
        return Eigen::Vector3d(across * std::cos(turn), across * std::sin(turn), 20 * std::sin(angle));
    };
    reconstruct::ReconstructRequest request;
    request.max_gap = 8;
    const Reconstruction torus = reconstruct::reconstruct(scattered(30000, 2, on_torus), request);
    expect_orientable(torus.mesh);
    EXPECT_LE(torus.borders, 5);
    EXPECT_NEAR(volume(torus.mesh) / (2 * std::pow(std::numbers::pi, 2) * 50 * 400), 1, 5e-3);
    EXPECT_LE(
        max_error(torus.mesh, [](const Eigen::Vector3d& p) { return std::hypot(p.head<2>().norm() - 50, p.z()) - 20; }),
        1.4 * torus.max_gap * torus.max_gap / (8 * 20.0));

    const auto on_cylinder = [](double u, double v) {
        const double angle = 2 * std::numbers::pi * v;
        return Eigen::Vector3d(30 * std::cos(angle), 30 * std::sin(angle), 100 * u);
    };
    const Reconstruction cylinder = reconstruct::reconstruct(scattered(20000, 3, on_cylinder), request);
    expect_orientable(cylinder.mesh);
    EXPECT_NEAR(area(cylinder.mesh) / (2 * std::numbers::pi * 3000), 1, 0.01);
    // Its ends are wider than the gap, and stay open.
    for (const auto& c : cylinder.mesh.triangles.colwise())
        EXPECT_GT(cylinder.mesh.points.xyz(Eigen::all, c).topRows<2>().rowwise().mean().norm(), 29);
}

TEST(Reconstruct, HolesWiderThanTheGapStayOpen)
{
    cloud::Cloud plane;
    const auto is_hole = [](double x, double y) { return std::hypot(x - 20, y - 20) < 4.2; };
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 40; ++i)
        for (int k = 0; k <= 40; ++k)
            if (!is_hole(i, k)) points.emplace_back(i, k, 0.01 * ((i * 7 + k * 11) % 5));
    // In an order of no scanner.
    std::mt19937_64 random(4);
    for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[geometry::draw_index(random, i)]);
    plane.xyz.resize(3, std::ssize(points));
    for (Eigen::Index i = 0; i < plane.xyz.cols(); ++i) plane.xyz.col(i) = points[static_cast<std::size_t>(i)];
    const auto holds_middle = [](const mesh::CloudMesh& part) {
        for (const auto& c : part.triangles.colwise()) {
            const Eigen::Matrix3d p = part.points.xyz(Eigen::all, c);
            bool is_inside = true;
            for (int k = 0; k < 3; ++k) {
                const Eigen::Vector3d edge = p.col((k + 1) % 3) - p.col(k),
                                      to = Eigen::Vector3d(20.1, 20.2, 0) - p.col(k);
                is_inside = is_inside && edge.x() * to.y() - edge.y() * to.x() > 0;
            }
            if (is_inside) return true;
        }
        return false;
    };
    reconstruct::ReconstructRequest request;
    request.facing = Eigen::Vector3d(0, 0, 1);
    for (const auto& [gap, is_filled] : {std::pair{3.0, false}, {6.0, false}, {11.0, true}}) {
        request.max_gap = gap;
        const Reconstruction result = reconstruct::reconstruct(plane, request);
        EXPECT_EQ(holds_middle(result.mesh), is_filled) << gap;
        EXPECT_EQ(result.borders, is_filled ? 1 : 2) << gap;
        EXPECT_LE(longest_edge(result.mesh), gap);
        EXPECT_NEAR(area(result.mesh), 1600 - (is_filled ? 0 : std::numbers::pi * 4.7 * 4.7), 12) << gap;
    }
}

TEST(Reconstruct, TwoSidesOfAThinWallStayApart)
{
    cloud::Cloud wall = scattered(8000, 5, [](double u, double v) {
        const bool is_upper = u < 0.5;
        return Eigen::Vector3d(40 * (is_upper ? 2 * u : 2 * u - 1), 40 * v, is_upper ? 1 : 0);
    });
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, wall.size());
    normals.row(2) = (2 * wall.xyz.row(2).array() - 1).matrix();
    cloud::set_normals(wall, normals);
    reconstruct::ReconstructRequest request;
    request.max_gap = 3;
    const Reconstruction result = reconstruct::reconstruct(wall, request);
    EXPECT_EQ(result.side, reconstruct::OuterSide::normals);
    for (const auto& c : result.mesh.triangles.colwise()) {
        const Eigen::Matrix3d p = result.mesh.points.xyz(Eigen::all, c);
        EXPECT_EQ(p.row(2).minCoeff(), p.row(2).maxCoeff());
        EXPECT_EQ((p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).z() > 0, p(2, 0) > 0.5);
    }
}

/// Profiles along y, 0.3 mm from point to point, 5 mm apart, over a wave; every third profile is shorter.
cloud::Cloud profiler_scan(double direction)
{
    std::vector<Eigen::Vector3d> points;
    for (int p = 0; p < 20; ++p)
        for (int k = 0; k < (p % 3 == 0 ? 150 : 200); ++k) {
            const double y = direction * 0.3 * k + 0.01 * (p % 2);
            points.emplace_back(5 * p, y, std::sin(p * 0.4) + 0.02 * ((k * 5) % 3));
        }
    cloud::Cloud cloud;
    cloud.xyz.resize(3, std::ssize(points));
    for (Eigen::Index i = 0; i < cloud.xyz.cols(); ++i) cloud.xyz.col(i) = points[static_cast<std::size_t>(i)];
    return cloud;
}

TEST(Reconstruct, ProfilesAreJoinedAlongTheirOrder)
{
    for (const double direction : {1.0, -1.0}) {
        const cloud::Cloud scan = profiler_scan(direction);
        const auto profiles = cloud::find_profiles(scan.xyz);
        ASSERT_TRUE(profiles);
        EXPECT_EQ(profiles->first.size(), 21u);
        EXPECT_NEAR(profiles->direction.y(), direction, 1e-3);
        const Reconstruction result = reconstruct::reconstruct(scan, {});
        EXPECT_EQ(result.order, "profiles");
        EXPECT_EQ(result.borders, 1);
        EXPECT_LE(result.left_out,
                  10); // at the ends of profiles that are longer than their neighbours by more than the gap
        expect_orientable(result.mesh);
        for (const auto& c : result.mesh.triangles.colwise()) {
            const Eigen::Matrix3d p = result.mesh.points.xyz(Eigen::all, c);
            EXPECT_GT((p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).z(), 0);
        }
        // Seen from below, it faces down.
        reconstruct::ReconstructRequest request;
        request.from = Eigen::Vector3d(50, 30, -400);
        const Reconstruction below = reconstruct::reconstruct(scan, request);
        const Eigen::Matrix3d p = below.mesh.points.xyz(Eigen::all, below.mesh.triangles.col(0));
        EXPECT_LT((p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).z(), 0);
    }
    // Profiles whose points come in another order are not recognised as such.
    cloud::Cloud scan = profiler_scan(1);
    std::mt19937_64 random(6);
    for (Eigen::Index i = scan.size(); i > 1; --i) {
        const auto other = static_cast<Eigen::Index>(geometry::draw_index(random, static_cast<std::size_t>(i)));
        scan.xyz.col(i - 1).swap(scan.xyz.col(other));
    }
    EXPECT_FALSE(cloud::find_profiles(scan.xyz));
}

// A file of merged scans that were moved states a viewpoint from which nobody has seen the far side: it decides
// nothing.
TEST(Reconstruct, NoViewpointSeesAllSides)
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    cloud::Cloud scan;
    scan.xyz.resize(3, 4000);
    for (auto p : scan.xyz.colwise())
        p = 20 * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    for (const double distance : {-200.0, 200.0}) {
        scan.view_origin = {distance, 3, -2};
        const Reconstruction result = reconstruct::reconstruct(scan, {});
        EXPECT_EQ(result.side, reconstruct::OuterSide::guessed);
        EXPECT_GT(volume(result.mesh), 0);
    }
}

// A sphere thinned to one point in each cube of a grid, in the order of the cubes: rows that run one way, and yet no
// profiles, since the points lie anywhere in their cubes. The Delaunay stars leave out next to none.
TEST(Reconstruct, RowsOfCubesAreNoProfiles)
{
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    std::map<std::array<int, 3>, Eigen::Vector3d> cubes; // by z, y, x
    for (int k = 0; k < 100'000; ++k) {
        const Eigen::Vector3d p = 20 * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
        const Eigen::Array3i cube = p.array().floor().cast<int>();
        cubes.try_emplace({cube.z(), cube.y(), cube.x()}, p);
    }
    cloud::Cloud scan;
    scan.xyz.resize(3, std::ssize(cubes));
    Eigen::Index next = 0;
    for (const auto& [cube, point] : cubes) scan.xyz.col(next++) = point;
    EXPECT_FALSE(cloud::find_profiles(scan.xyz));
    const Reconstruction result = reconstruct::reconstruct(scan, {});
    EXPECT_EQ(result.order, "none");
    EXPECT_LT(static_cast<double>(result.left_out), 0.01 * static_cast<double>(scan.size()));
}

TEST(Reconstruct, GridsKeepTheirHoles)
{
    cloud::Cloud grid;
    grid.width = 30;
    grid.xyz.resize(3, 30 * 20);
    for (Eigen::Index i = 0; i < grid.size(); ++i) {
        const double x = static_cast<double>(i % 30), y = static_cast<double>(i / 30);
        grid.xyz.col(i) << x, y, x > 14.5 ? 9.0 : 0.0; // a step, which no triangle climbs
    }
    grid.xyz.col(5 + 10 * 30).setConstant(core::kNaN);
    const Reconstruction result = reconstruct::reconstruct(grid, {});
    EXPECT_EQ(result.order, "grid");
    EXPECT_EQ(result.mesh.points.size(), 599);
    EXPECT_EQ(result.borders, 3);                               // two pieces, and the missing point
    EXPECT_DOUBLE_EQ(area(result.mesh), 14 * 19 + 14 * 19 - 2); // four half squares are missing
    expect_orientable(result.mesh);
}

TEST(Reconstruct, LoopsAreFilledWithTheSmallestArea)
{
    Eigen::Matrix3Xd xyz(3, 5); // a square with one corner pushed in: two triangulations, one of them twice as large
    xyz << 0, 4, 4, 0, 1, /**/ 0, 0, 4, 4, 2, /**/ 0, 0, 0, 0, 0;
    double sum = 0;
    const auto triangles = reconstruct::triangulate_loop({0, 1, 2, 3, 4}, xyz);
    ASSERT_EQ(triangles.size(), 3u);
    for (const Eigen::Vector3i& c : triangles) {
        const Eigen::Matrix3d p = xyz(Eigen::all, c);
        EXPECT_GE((p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).z(), 0);
        sum += (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).z() / 2;
    }
    EXPECT_DOUBLE_EQ(sum, 14);
}

TEST(Reconstruct, TooFewPointsAreRefused)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Zero(3, 9);
    EXPECT_THROW(reconstruct::reconstruct(cloud, {}), core::InputError);
    cloud.xyz = 1e3 * Eigen::Matrix3Xd::Identity(3, 3);
    reconstruct::ReconstructRequest request;
    request.max_gap = 1;
    EXPECT_THROW(reconstruct::reconstruct(cloud, request), core::InputError);
}

} // namespace reconstruct_test
} // namespace fettle
