#include "align/align.h"

#include "cloud/viewpoint.h"
#include "core/error.h"
#include "draws.h"
#include "own_folder.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

namespace fettle {
namespace align_test {

struct Box {
    Eigen::Vector3d min, max;
    bool contains(const Eigen::Vector3d& p) const
    {
        return (p.array() > min.array()).all() && (p.array() < max.array()).all();
    }
};

// A bracket without any symmetry.
const std::vector<Box> kBracket = {
    {{0, 0, 0}, {100, 60, 10}}, {{0, 0, 10}, {12, 60, 55}}, {{12, 38, 10}, {45, 46, 30}}, {{70, 5, 10}, {90, 20, 22}}};

mesh::Mesh mesh_of(const std::vector<Box>& boxes)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8 * static_cast<Eigen::Index>(boxes.size()));
    mesh.triangles.resize(3, 12 * static_cast<Eigen::Index>(boxes.size()));
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Eigen::Index t = 0;
    for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
        const Box& box = boxes[static_cast<std::size_t>(b)];
        for (int k = 0; k < 8; ++k)
            for (int axis = 0; axis < 3; ++axis)
                mesh.vertices(axis, 8 * b + k) = (k >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
        for (const auto& f : faces) {
            mesh.triangles.col(t++) << 8 * b + f[0], 8 * b + f[1], 8 * b + f[2];
            mesh.triangles.col(t++) << 8 * b + f[0], 8 * b + f[2], 8 * b + f[3];
        }
    }
    return mesh;
}

// Points of the mesh that lie inside none of the boxes, with noise; `seen`: only faces that point in that direction.
align::OrientedPoints scan_of(const std::vector<Box>& boxes, Eigen::Index count, double noise, unsigned seed,
                              const Eigen::Vector3d& seen = Eigen::Vector3d::Zero())
{
    align::OrientedPoints scan = align::oriented_points(mesh_of(boxes), 3 * count);
    std::vector<Eigen::Index> outside;
    for (Eigen::Index i = 0; i < scan.xyz.cols(); ++i) {
        const Eigen::Vector3d above = scan.xyz.col(i) + 1e-6 * scan.normals.col(i);
        const bool hidden =
            std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(above); });
        if (!hidden && (seen.isZero(0) || scan.normals.col(i).dot(seen) > 0.1)) outside.push_back(i);
    }
    std::mt19937 random(seed);
    std::shuffle(outside.begin(), outside.end(), random);
    outside.resize(std::min(outside.size(), static_cast<std::size_t>(count)));
    scan.xyz = Eigen::Matrix3Xd(scan.xyz(Eigen::all, outside));
    scan.normals = Eigen::Matrix3Xd(scan.normals(Eigen::all, outside));
    std::normal_distribution<double> normal(0, noise);
    for (auto p : scan.xyz.colwise()) p += Eigen::Vector3d(normal(random), normal(random), normal(random));
    return scan;
}

Eigen::Isometry3d random_motion(unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto next = [&] { return normal(random); };
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = Eigen::Quaterniond(Eigen::Vector4d::NullaryExpr(next).normalized()).toRotationMatrix();
    motion.translation() = 300 * Eigen::Vector3d::NullaryExpr(next);
    return motion;
}

align::OrientedPoints moved_by(const Eigen::Isometry3d& motion, align::OrientedPoints scan)
{
    scan.xyz = motion * scan.xyz;
    scan.normals = motion.linear() * scan.normals;
    return scan;
}

// How far `found` is from no motion, in the alignment's own standard deviations: chi square with 6 degrees of freedom.
double chi_square(const align::Alignment& a, const Eigen::Isometry3d& found)
{
    const Eigen::AngleAxisd turn(found.linear());
    align::Twist x;
    x << found * a.frame.centre - a.frame.centre, turn.angle() * turn.axis() * a.frame.radius;
    double sum = 0;
    for (const align::MotionMode& freedom : a.modes) sum += std::pow(freedom.motion.dot(x) / freedom.sd, 2);
    return sum;
}

constexpr double kChiSquare999 = 22.46; // 6 degrees of freedom, 99.9 %

// Reference: the motion that the scan was given.
TEST(Align, FindsTheScanFromAnywhere)
{
    const align::AlignReference reference(mesh_of(kBracket));
    for (int seed = 1; seed <= draws(6); ++seed) {
        const align::OrientedPoints scan = scan_of(kBracket, 1500, 0.3, seed);
        const Eigen::Isometry3d motion = random_motion(seed);
        const align::Alignment a = align::align(moved_by(motion, scan), reference, {});
        EXPECT_TRUE(a.fit.converged);
        EXPECT_GT(a.fit.overlap, 0.98);
        EXPECT_NEAR(a.fit.sigma, 0.3, 0.03);
        EXPECT_LT(chi_square(a, a.fit.T_reference_scan * motion), kChiSquare999);
        EXPECT_FALSE(align::is_ambiguous(a));
    }
}

// One side only, against a cloud without normals (its edges are rounded by their estimate), with a fifth of the points
// on another object 20 mm beside it: found to within the noise of a point.
TEST(Align, PartOfThePartWithClutter)
{
    const align::OrientedPoints all = scan_of(kBracket, 6000, 0, 1);
    cloud::Cloud cloud;
    cloud.xyz = all.xyz;
    const align::AlignReference reference(cloud);
    for (int seed = 1; seed <= draws(4); ++seed) {
        align::OrientedPoints scan = scan_of(kBracket, 1500, 0.2, seed, Eigen::Vector3d(0.3, -0.5, 1));
        const Eigen::Index clutter = scan.xyz.cols() / 5;
        scan.xyz.leftCols(clutter) = 10 * Eigen::Matrix3Xd::Random(3, clutter);
        scan.xyz.leftCols(clutter).colwise() += Eigen::Vector3d(120, 80, 20);
        const Eigen::Isometry3d motion = random_motion(seed);
        const align::Alignment a = align::align(moved_by(motion, scan), reference, {});
        EXPECT_NEAR(a.fit.overlap, 0.8, 0.03);
        const Eigen::Matrix3Xd on = scan.xyz.rightCols(scan.xyz.cols() - clutter);
        EXPECT_LT(((a.fit.T_reference_scan * motion) * on - on).colwise().norm().maxCoeff(), 0.2);
    }
}

// Without noise and with an anomaly on a fifth of it, the motion comes back to rounding.
TEST(Align, AnAnomalyDoesNotPull)
{
    const align::AlignReference reference(mesh_of(kBracket));
    align::OrientedPoints scan = scan_of(kBracket, 2000, 0, 3);
    const Eigen::Index heap = scan.xyz.cols() / 5;
    scan.xyz.leftCols(heap) += 2 * scan.normals.leftCols(heap);
    const Eigen::Isometry3d motion = random_motion(3);
    const align::Alignment a = align::align(moved_by(motion, scan), reference, {});
    EXPECT_LT(((a.fit.T_reference_scan * motion) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 1e-5);
}

// Given the overlap, exactly that share is taken to lie on the reference, be it less than what does; the pose is right
// to within the noise of a point.
TEST(Align, TakesTheShareThatIsGiven)
{
    const align::AlignReference reference(mesh_of(kBracket));
    align::OrientedPoints scan = scan_of(kBracket, 2000, 0.2, 3);
    const Eigen::Index heap = scan.xyz.cols() / 5;
    scan.xyz.leftCols(heap) += 2 * scan.normals.leftCols(heap);
    for (const double share : {0.5, 0.75}) {
        align::AlignOptions options;
        options.icp.overlap = share;
        const Eigen::Isometry3d motion = random_motion(3);
        const align::Alignment a = align::align(moved_by(motion, scan), reference, options);
        EXPECT_NEAR(a.fit.overlap, share, 1e-9);
        EXPECT_LT(((a.fit.T_reference_scan * motion) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 0.2);
    }
}

// The predicted standard deviations against repetitions, to within four standard errors of a standard deviation: 20 %
// of 200.
TEST(Align, StandardDeviationsHold)
{
    const align::AlignReference reference(mesh_of(kBracket));
    std::vector<align::Twist> error;
    std::array<double, 6> predicted{};
    const int runs = draws(200);
    for (int seed = 0; seed < runs; ++seed) {
        const align::OrientedPoints scan = scan_of(kBracket, 500, 0.1, seed);
        align::AlignOptions options;
        options.start = Eigen::Isometry3d::Identity();
        options.icp.max_distance = 2;
        const align::Alignment a = align::align(scan, reference, options);
        const Eigen::AngleAxisd turn(a.fit.T_reference_scan.linear());
        align::Twist x;
        x << a.fit.T_reference_scan * a.frame.centre - a.frame.centre, turn.angle() * turn.axis() * a.frame.radius;
        error.push_back(x);
        for (Eigen::Index k = 0; k < 6; ++k) {
            double variance = 0;
            for (const align::MotionMode& freedom : a.modes) variance += std::pow(freedom.motion[k] * freedom.sd, 2);
            predicted[static_cast<std::size_t>(k)] += std::sqrt(variance) / runs;
        }
    }
    for (Eigen::Index k = 0; k < 6; ++k) {
        double square = 0;
        for (const align::Twist& x : error) square += x[k] * x[k] / runs;
        EXPECT_NEAR(std::sqrt(square) / predicted[static_cast<std::size_t>(k)], 1, 4 / std::sqrt(2.0 * runs));
    }
}

int determined(const align::Alignment& a)
{
    return static_cast<int>(std::count_if(a.modes.begin(), a.modes.end(),
                                          [](const align::MotionMode& freedom) { return freedom.determined; }));
}

// A plane leaves three motions undetermined, a sphere three, a cylinder two: these keep their start values, but for the
// second-order effect of the motion of 0.5, 0.5²/50.
TEST(Align, WhatIsNotDeterminedStays)
{
    const auto surface = [](const std::string& kind) {
        cloud::Cloud cloud;
        cloud.xyz.resize(3, 4000);
        for (Eigen::Index i = 0; i < cloud.size(); ++i) {
            const double u = 0.7 * (static_cast<double>(i % 63) / 31 - 1),
                         v = 0.7 * (static_cast<double>(i) / 2000 - 1);
            const double z = kind == "plane"      ? 0
                             : kind == "cylinder" ? std::sqrt(1 - u * u)
                                                  : std::sqrt(1 - u * u - v * v);
            cloud.xyz.col(i) << 50 * u, 50 * v, 50 * z;
        }
        return cloud;
    };
    for (const auto& [kind, expected_dof] : {std::pair("plane", 3), std::pair("cylinder", 4), std::pair("sphere", 3)}) {
        const align::AlignReference reference(surface(kind));
        align::OrientedPoints scan = align::oriented_points(surface(kind));
        scan.xyz.row(2).array() += 0.5;
        align::AlignOptions options;
        options.start = Eigen::Isometry3d::Identity();
        const align::Alignment a = align::align(scan, reference, options);
        EXPECT_EQ(determined(a), expected_dof) << kind;
        EXPECT_NEAR(a.fit.T_reference_scan.translation().z(), -0.5, 1e-3) << kind;
        EXPECT_NEAR((a.fit.T_reference_scan * a.frame.centre - a.frame.centre).head<2>().norm(), 0, 5e-3) << kind;
    }
}

TEST(Align, HeldAxesDoNotMove)
{
    const align::AlignReference reference(mesh_of(kBracket));
    align::OrientedPoints scan = scan_of(kBracket, 1500, 0.05, 1);
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()));
    align::AlignOptions options;
    options.icp.held = {false, false, true, true, true, false};
    const align::Alignment a = align::align(moved_by(turn, scan), reference, options);
    EXPECT_TRUE(a.fit.T_reference_scan.linear().col(2).isApprox(Eigen::Vector3d::UnitZ(), 1e-14));
    EXPECT_NEAR(a.fit.T_reference_scan.translation().z(), 0, 1e-12);
    EXPECT_LT(((a.fit.T_reference_scan * turn) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 0.02);
    EXPECT_EQ(std::count_if(a.modes.begin(), a.modes.end(), [](const align::MotionMode& f) { return f.held; }), 3);
}

// Two poses that fit equally well are reported: a plain box turned by half a turn.
TEST(Align, ReportsAnAmbiguousPose)
{
    const std::vector<Box> box = {{{0, 0, 0}, {60, 40, 20}}};
    const align::Alignment a = align::align(scan_of(box, 1200, 0.1, 1), align::AlignReference(mesh_of(box)), {});
    ASSERT_TRUE(a.second_best);
    EXPECT_TRUE(align::is_ambiguous(a));
}

// A closed free-form body, another one for each seed.
mesh::Mesh lump(unsigned seed, const Eigen::Vector3d& centre)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto next = [&] { return normal(random); };
    const Eigen::Vector3d a = Eigen::Vector3d::NullaryExpr(next), b = Eigen::Vector3d::NullaryExpr(next);
    constexpr int kRings = 40, kSides = 80;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (kRings + 1) * kSides);
    mesh.triangles.resize(3, 2 * kRings * kSides);
    for (int i = 0, t = 0; i <= kRings; ++i)
        for (int j = 0; j < kSides; ++j) {
            const double u = std::numbers::pi * i / kRings, v = 2 * std::numbers::pi * j / kSides;
            const Eigen::Vector3d d(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
            const double radius = 30 * (1 + 0.2 * std::sin(3 * d.dot(a) + 1) + 0.12 * std::sin(5 * d.dot(b)));
            mesh.vertices.col(i * kSides + j) = centre + radius * d;
            if (i == kRings) continue;
            const int right = i * kSides + (j + 1) % kSides;
            mesh.triangles.col(t++) << i * kSides + j, i * kSides + j + kSides, right + kSides;
            mesh.triangles.col(t++) << i * kSides + j, right + kSides, right;
        }
    return mesh;
}

// What is seen from above of five bodies on a floor, with noise. The normals are estimated.
cloud::Cloud scene_of_lumps()
{
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.2);
    std::vector<Eigen::Vector3d> seen;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const Eigen::Vector3d centre(90.0 * (seed % 3), 90.0 * (seed / 3), 40);
        const align::OrientedPoints points = align::oriented_points(lump(seed, centre), 4000);
        for (Eigen::Index i = 0; i < points.xyz.cols(); ++i)
            if (points.normals(2, i) > 0.1) seen.emplace_back(points.xyz.col(i));
    }
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 70; ++j) seen.emplace_back(4.0 * i - 100, 4.0 * j - 90, 0);
    cloud::Cloud scene;
    scene.xyz.resize(3, static_cast<Eigen::Index>(seen.size()));
    for (Eigen::Index i = 0; i < scene.xyz.cols(); ++i)
        scene.xyz.col(i) =
            seen[static_cast<std::size_t>(i)] + Eigen::Vector3d(noise(random), noise(random), noise(random));
    scene.view_origin = {90, 90, 1000};
    return scene;
}

// A thinned cloud has so many of its points, with their normals; a mesh is never thinned.
TEST(Align, ThinsACloud)
{
    const align::OrientedPoints all = scan_of(kBracket, 500, 0, 1);
    const align::AlignReference reference(all);
    const std::optional<align::AlignReference> thinned = reference.thinned(100);
    ASSERT_TRUE(thinned);
    const align::OrientedPoints& few = thinned->points();
    ASSERT_EQ(few.xyz.cols(), 100);
    EXPECT_EQ(few.outward, all.outward);
    for (Eigen::Index i = 0; i < few.xyz.cols(); ++i) {
        Eigen::Index same = 0;
        EXPECT_EQ((all.xyz.colwise() - few.xyz.col(i)).colwise().norm().minCoeff(&same), 0);
        EXPECT_EQ(few.normals.col(i), all.normals.col(same));
    }
    EXPECT_FALSE(reference.thinned(500));
    EXPECT_FALSE(align::AlignReference(mesh_of(kBracket)).thinned(3));
}

// A small object among others, of which less than half is seen. Reference: the motion that it was given.
TEST(Align, ASmallObjectInAScene)
{
    const align::AlignReference reference(scene_of_lumps());
    const align::OrientedPoints object = align::oriented_points(lump(3, {0, 90, 40}), 2000);
    align::AlignOptions options;
    options.icp.max_distance = 1;
    for (int seed = 1; seed <= draws(3); ++seed) {
        const Eigen::Isometry3d motion = random_motion(static_cast<unsigned>(seed));
        const align::Alignment a = align::align(moved_by(motion, object), reference, options);
        EXPECT_LT(((a.fit.T_reference_scan * motion) * object.xyz - object.xyz).colwise().norm().maxCoeff(), 0.5);
        EXPECT_EQ(align::doubts(a, options.icp), std::vector<std::string>());
    }
}

// A cloud that states no viewpoint gets normals to one side, wherever it was moved: here the origin lies on it. A known
// viewpoint turns them to itself, inside as well. Reference: the sphere's own normals.
TEST(Align, NormalsWithoutAViewpointPointToOneSide)
{
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    cloud::Cloud cloud;
    cloud.xyz.resize(3, 3000);
    for (auto p : cloud.xyz.colwise())
        p = 20 * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const auto outward_share = [](const cloud::Cloud& sphere, const Eigen::Vector3d& middle) {
        const align::OrientedPoints points = align::oriented_points(sphere);
        const Eigen::Matrix3Xd out = points.xyz.colwise() - middle;
        return ((points.normals.array() * out.array()).colwise().sum() > 0).cast<double>().mean();
    };
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.translation().x() = 20;
    EXPECT_EQ(outward_share(cloud::transformed(cloud, motion.matrix(), 1), {20, 0, 0}), 1);
    cloud::set_viewpoint(cloud, {0, 0, 0}, Eigen::Quaterniond::Identity());
    EXPECT_EQ(outward_share(cloud::transformed(cloud, motion.matrix(), 1), {20, 0, 0}), 0);
}

// Far away the distances along the normals vanish, too: the steps become short, but the scan is not there.
TEST(Align, FarFromTheReferenceIsNotConverged)
{
    const align::AlignReference reference(mesh_of(kBracket));
    align::AlignOptions options;
    options.start = Eigen::Translation3d(1.4e6, 0, 0) * Eigen::Isometry3d::Identity();
    const align::Alignment a = align::align(scan_of(kBracket, 1500, 0.1, 1), reference, options);
    EXPECT_FALSE(a.fit.converged);
    EXPECT_FALSE(align::doubts(a, options.icp).empty());
}

// The gradient against central differences.
TEST(Align, Gradient)
{
    const align::TwistFrame frame{{1, 2, 3}, 20};
    const Eigen::Vector3d point(11, -7, 5), direction = Eigen::Vector3d(1, -1, 2).normalized();
    const align::Twist g = frame.gradient(point, direction);
    for (Eigen::Index k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-4; // rounding 1e-15 / 1e-4, truncation (1e-4)²
        const align::Twist x = kStep * align::Twist::Unit(k);
        const double up = direction.dot(frame.motion(x) * point), down = direction.dot(frame.motion(-x) * point);
        EXPECT_NEAR(g[k], (up - down) / (2 * kStep), 1e-8);
    }
}

// Shares of a distance list that is known: 70 % within 0.1, the rest far away.
TEST(Align, TrimFindsTheOverlap)
{
    Eigen::VectorXd closest = Eigen::VectorXd::LinSpaced(1000, 0.001, 0.1);
    closest.tail(300).setLinSpaced(5, 50);
    const align::Trim found = align::estimate_overlap(closest, 1e-9);
    EXPECT_NEAR(static_cast<double>((closest.array() <= found.cutoff).count()), 700, 1);
    closest.head(700).setZero();
    EXPECT_EQ(align::estimate_overlap(closest, 1e-9).cutoff, 0);
}

TEST(Align, TransformFilesKeepEveryBit)
{
    const OwnFolder folder;
    const Eigen::Matrix4d matrix = random_motion(7).matrix();
    std::ofstream file("T.txt");
    align::write_transform(file, matrix);
    file.close();
    EXPECT_EQ(align::read_transform("T.txt"), matrix);
}

TEST(Align, Refuses)
{
    const align::AlignReference reference(mesh_of(kBracket));
    align::OrientedPoints few{Eigen::Matrix3Xd::Random(3, 5), Eigen::Matrix3Xd::Zero(3, 5)};
    EXPECT_THROW(align::align(few, reference, {}), core::InputError);
    align::OrientedPoints one_place{Eigen::Matrix3Xd::Ones(3, 50), Eigen::Matrix3Xd::Zero(3, 50)};
    EXPECT_THROW(align::align(one_place, reference, {}), core::InputError);
    EXPECT_THROW(align::AlignReference(cloud::Cloud{}), core::InputError);
}

} // namespace align_test
} // namespace fettle
