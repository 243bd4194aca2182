// Random pairs of solids and of solids and triangles against FCL.

#include "boat_hull.h"
#include "mesh/mesh_file.h"
#include "robot/clearance.h"
#include "robot/hull_points.h"
#include "robot/workpiece.h"

#include <fcl/fcl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace fettle {
namespace fcl_test {

using Eigen::Isometry3d, Eigen::Vector3d;

/// A solid for both, about the origin, z its axis.
struct Shape {
    robot::Solid ours;
    std::shared_ptr<fcl::CollisionGeometryd> theirs;
};

class Draw {
  public:
    explicit Draw(unsigned seed) : random_(seed) {}
    double number(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }
    Isometry3d placement(double size)
    {
        std::normal_distribution<double> normal;
        const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([&] { return normal(random_); }).normalized();
        const Vector3d at = Vector3d::NullaryExpr([&] { return number(-size, size); });
        return Eigen::Translation3d(at) * Eigen::Quaterniond(q);
    }
    Shape shape(unsigned kind)
    {
        const double radius = number(2, 12), length = number(4, 40);
        const Vector3d from(0, 0, -length / 2), to(0, 0, length / 2), half(radius, number(2, 12), length / 2);
        switch (kind) {
        case 0:
            return {robot::solid::Sphere{Vector3d::Zero(), radius}, std::make_shared<fcl::Sphered>(radius)};
        case 1:
            return {robot::solid::Capsule{from, to, radius}, std::make_shared<fcl::Capsuled>(radius, length)};
        case 2:
            return {robot::solid::Cylinder{from, to, radius}, std::make_shared<fcl::Cylinderd>(radius, length)};
        case 3:
            return {robot::solid::Cone{from, to, radius, 0}, std::make_shared<fcl::Coned>(radius, length)};
        default:
            return {robot::solid::Box{Isometry3d::Identity(), half}, std::make_shared<fcl::Boxd>(2 * half)};
        }
    }

  private:
    std::mt19937 random_;
};

// FCL reports overlaps, but not their depth.
TEST(Fcl, RandomPairs)
{
    constexpr double kAccuracy = 1e-3;
    Draw draw(21);
    int separate = 0, overlapping = 0;
    for (unsigned k = 0; k < 4000; ++k) {
        const Shape a = draw.shape(k % 5), b = draw.shape(k / 5 % 5);
        const double size = k % 3 == 0 ? 25 : 12;
        const Isometry3d T_a = draw.placement(size), T_b = draw.placement(size);
        const double ours = robot::clearance(robot::PlacedSolid(a.ours, T_a), robot::PlacedSolid(b.ours, T_b)).distance;
        fcl::CollisionObjectd at_a(a.theirs, T_a), at_b(b.theirs, T_b);
        fcl::CollisionResultd collision;
        const bool overlap = fcl::collide(&at_a, &at_b, fcl::CollisionRequestd(1, false), collision) > 0;
        if (std::abs(ours) > kAccuracy) {
            EXPECT_EQ(overlap, ours < 0) << k << " " << ours;
        }
        ++(ours < 0 ? overlapping : separate);
        if (ours < kAccuracy) continue;
        fcl::DistanceRequestd request(true);
        fcl::DistanceResultd distance;
        EXPECT_NEAR(fcl::distance(&at_a, &at_b, request, distance), ours, kAccuracy) << k;
    }
    EXPECT_GT(separate, 1000);
    EXPECT_GT(overlapping, 1000);
}

TEST(Fcl, RandomSolidsAgainstAMesh)
{
    constexpr double kAccuracy = 1e-3;
    Draw draw(22);
    const mesh::Mesh mesh = boat::hull(4000);
    const robot::Workpiece workpiece(mesh);
    const auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    for (const auto t : mesh.triangles.colwise())
        model->addTriangle(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2]));
    model->endModel();
    fcl::CollisionObjectd hull(model);
    int separate = 0, overlapping = 0;
    for (unsigned k = 0; k < 3000; ++k) {
        const Shape a = draw.shape(k % 5);
        const Isometry3d T = Eigen::Translation3d(0, 0, 50) * draw.placement(90);
        const double ours = workpiece.nearest(robot::PlacedSolid(a.ours, T)).clearance.distance;
        fcl::CollisionObjectd at_a(a.theirs, T);
        fcl::CollisionResultd collision;
        const bool overlap = fcl::collide(&hull, &at_a, fcl::CollisionRequestd(1, false), collision) > 0;
        if (std::abs(ours) > kAccuracy) {
            EXPECT_EQ(overlap, ours < 0) << k << " " << ours;
        }
        ++(ours < 0 ? overlapping : separate);
    }
    EXPECT_GT(separate, 500);
    EXPECT_GT(overlapping, 500);
}

mesh::Mesh read(const std::string& name)
{
    const char* samples = std::getenv("SAMPLES");
    return mesh::read_mesh((samples == nullptr ? "" : std::string(samples) + "/../") + "tests/data/" + name,
                           units::Units::Length::mm);
}

std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_of(const mesh::Mesh& mesh)
{
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    for (const auto t : mesh.triangles.colwise())
        model->addTriangle(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2]));
    model->endModel();
    return model;
}

/// The faces of FCL's body are all triangles of its points that have the others on one side.
std::shared_ptr<fcl::Convexd> convex_of(const Eigen::Matrix3Xd& points)
{
    constexpr double kFlatness = 1e-6; // mm
    auto vertices = std::make_shared<std::vector<Vector3d>>();
    for (const auto p : points.colwise()) vertices->push_back(p);
    auto faces = std::make_shared<std::vector<int>>();
    int count = 0;
    const int n = static_cast<int>(points.cols());
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j)
            for (int k = j + 1; k < n; ++k) {
                const Vector3d normal =
                    (points.col(j) - points.col(i)).cross(points.col(k) - points.col(i)).normalized();
                const Eigen::RowVectorXd height = normal.transpose() * (points.colwise() - points.col(i));
                if (!(normal.norm() > 0.5) || (height.maxCoeff() > kFlatness && height.minCoeff() < -kFlatness))
                    continue;
                const bool outwards = height.maxCoeff() <= kFlatness;
                faces->insert(faces->end(), {3, i, outwards ? j : k, outwards ? k : j});
                ++count;
            }
    return std::make_shared<fcl::Convexd>(vertices, count, faces);
}

// FCL's own piano in FCL's own flat: the hull of the piano at poses all over it.
TEST(Fcl, APianoInAFlat)
{
    constexpr double kAccuracy = 1e-3;
    Draw draw(23);
    const mesh::Mesh flat = read("fcl_env.obj");
    const Eigen::Matrix3Xd points = read("fcl_rob.obj").vertices, hull_points = robot::hull_points(points);
    EXPECT_LT(hull_points.cols(), points.cols() / 4);
    const robot::Workpiece workpiece(flat);
    const robot::Solid all = robot::solid::Hull{points}, hull = robot::solid::Hull{hull_points};
    fcl::CollisionObjectd their_flat(model_of(flat));
    const auto their_hull = convex_of(hull_points);
    int separate = 0, overlapping = 0, differences = 0;
    for (unsigned k = 0; k < 1500; ++k) {
        const Isometry3d T = Eigen::Translation3d(0, 0, 900) * draw.placement(2500);
        const robot::PlacedSolid placed(hull, T);
        const double ours = workpiece.nearest_of_surface(placed, 5000, 0).clearance.distance;
        if (k % 10 == 0) {
            EXPECT_NEAR(ours, workpiece.nearest_of_surface(robot::PlacedSolid(all, T), 5000, 0).clearance.distance,
                        robot::kClearanceAccuracy);
        }
        if (std::abs(ours) < kAccuracy) continue;
        fcl::CollisionObjectd at(their_hull, T);
        fcl::CollisionResultd collision;
        const bool overlap = fcl::collide(&their_flat, &at, fcl::CollisionRequestd(1, false), collision) > 0;
        differences += overlap != (ours < 0);
        ++(ours < 0 ? overlapping : separate);
    }
    EXPECT_EQ(differences, 0);
    EXPECT_GT(separate, 300);
    EXPECT_GT(overlapping, 300);
}

} // namespace fcl_test
} // namespace fettle
