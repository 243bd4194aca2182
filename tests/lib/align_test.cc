#include "align/align.h"

#include "core/error.h"
#include "own_folder.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

namespace fettle {
namespace {

struct Box {
    Eigen::Vector3d least, most;
    bool holds(const Eigen::Vector3d& p) const
    {
        return (p.array() > least.array()).all() && (p.array() < most.array()).all();
    }
};

// A bracket without any symmetry.
const std::vector<Box> kBracket = {
    {{0, 0, 0}, {100, 60, 10}}, {{0, 0, 10}, {12, 60, 55}}, {{12, 38, 10}, {45, 46, 30}}, {{70, 5, 10}, {90, 20, 22}}};

Mesh mesh_of(const std::vector<Box>& boxes)
{
    Mesh mesh;
    mesh.vertices.resize(3, 8 * static_cast<Eigen::Index>(boxes.size()));
    mesh.triangles.resize(3, 12 * static_cast<Eigen::Index>(boxes.size()));
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Eigen::Index t = 0;
    for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
        const Box& box = boxes[static_cast<std::size_t>(b)];
        for (int k = 0; k < 8; ++k)
            for (int axis = 0; axis < 3; ++axis)
                mesh.vertices(axis, 8 * b + k) = (k >> axis & 1) != 0 ? box.most[axis] : box.least[axis];
        for (const auto& f : faces) {
            mesh.triangles.col(t++) << 8 * b + f[0], 8 * b + f[1], 8 * b + f[2];
            mesh.triangles.col(t++) << 8 * b + f[0], 8 * b + f[2], 8 * b + f[3];
        }
    }
    return mesh;
}

// Points of the mesh that lie inside none of the boxes, with noise; `seen`: only faces that look that way.
OrientedPoints scan_of(const std::vector<Box>& boxes, Eigen::Index count, double noise, unsigned seed,
                       const Eigen::Vector3d& seen = Eigen::Vector3d::Zero())
{
    OrientedPoints scan = oriented_points(mesh_of(boxes), 3 * count);
    std::vector<Eigen::Index> outside;
    for (Eigen::Index i = 0; i < scan.xyz.cols(); ++i) {
        const Eigen::Vector3d above = scan.xyz.col(i) + 1e-6 * scan.normals.col(i);
        const bool hidden = std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.holds(above); });
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

OrientedPoints moved_by(const Eigen::Isometry3d& motion, OrientedPoints scan)
{
    scan.xyz = motion * scan.xyz;
    scan.normals = motion.linear() * scan.normals;
    return scan;
}

// How far `found` is from no motion, in the alignment's own standard deviations: chi square with 6 degrees of freedom.
double chi_square(const Alignment& a, const Eigen::Isometry3d& found)
{
    const Eigen::AngleAxisd turn(found.linear());
    Twist x;
    x << found * a.frame.centre - a.frame.centre, turn.angle() * turn.axis() * a.frame.radius;
    double sum = 0;
    for (const Freedom& freedom : a.freedoms) sum += std::pow(freedom.motion.dot(x) / freedom.sd, 2);
    return sum;
}

constexpr double kChiSquare999 = 22.46; // 6 degrees of freedom, 99.9 %

// Reference: the motion that the scan was given.
TEST(Align, FindsTheScanFromAnywhere)
{
    const AlignReference reference(mesh_of(kBracket));
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const OrientedPoints scan = scan_of(kBracket, 1500, 0.3, seed);
        const Eigen::Isometry3d motion = random_motion(seed);
        const Alignment a = align(moved_by(motion, scan), reference, {});
        EXPECT_TRUE(a.fit.converged);
        EXPECT_GT(a.fit.overlap, 0.98);
        EXPECT_NEAR(a.fit.sigma, 0.3, 0.03);
        EXPECT_LT(chi_square(a, a.fit.T_reference_scan * motion), kChiSquare999);
        EXPECT_FALSE(ambiguous(a));
    }
}

// One side only, against a cloud without normals (its edges are rounded by their estimate), with a fifth of the points
// on something else that stands 20 mm beside: found to within the noise of a point.
TEST(Align, PartOfThePartWithClutter)
{
    const OrientedPoints all = scan_of(kBracket, 6000, 0, 1);
    Cloud cloud;
    cloud.xyz = all.xyz;
    const AlignReference reference(cloud);
    for (unsigned seed = 1; seed <= 4; ++seed) {
        OrientedPoints scan = scan_of(kBracket, 1500, 0.2, seed, Eigen::Vector3d(0.3, -0.5, 1));
        const Eigen::Index clutter = scan.xyz.cols() / 5;
        scan.xyz.leftCols(clutter) = 10 * Eigen::Matrix3Xd::Random(3, clutter);
        scan.xyz.leftCols(clutter).colwise() += Eigen::Vector3d(120, 80, 20);
        const Eigen::Isometry3d motion = random_motion(seed);
        const Alignment a = align(moved_by(motion, scan), reference, {});
        EXPECT_NEAR(a.fit.overlap, 0.8, 0.03);
        const Eigen::Matrix3Xd on = scan.xyz.rightCols(scan.xyz.cols() - clutter);
        EXPECT_LT(((a.fit.T_reference_scan * motion) * on - on).colwise().norm().maxCoeff(), 0.2);
    }
}

// Without noise and with an anomaly on a fifth of it, the motion comes back to rounding.
TEST(Align, AnAnomalyDoesNotPull)
{
    const AlignReference reference(mesh_of(kBracket));
    OrientedPoints scan = scan_of(kBracket, 2000, 0, 3);
    const Eigen::Index heap = scan.xyz.cols() / 5;
    scan.xyz.leftCols(heap) += 2 * scan.normals.leftCols(heap);
    const Eigen::Isometry3d motion = random_motion(3);
    const Alignment a = align(moved_by(motion, scan), reference, {});
    EXPECT_LT(((a.fit.T_reference_scan * motion) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 1e-5);
}

// Given the overlap, exactly that share is taken to lie on the reference, be it less than what does; the pose is right
// to within the noise of a point.
TEST(Align, TakesTheShareThatIsGiven)
{
    const AlignReference reference(mesh_of(kBracket));
    OrientedPoints scan = scan_of(kBracket, 2000, 0.2, 3);
    const Eigen::Index heap = scan.xyz.cols() / 5;
    scan.xyz.leftCols(heap) += 2 * scan.normals.leftCols(heap);
    for (const double share : {0.5, 0.75}) {
        AlignOptions options;
        options.icp.overlap = share;
        const Eigen::Isometry3d motion = random_motion(3);
        const Alignment a = align(moved_by(motion, scan), reference, options);
        EXPECT_NEAR(a.fit.overlap, share, 1e-9);
        EXPECT_LT(((a.fit.T_reference_scan * motion) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 0.2);
    }
}

// The predicted standard deviations against 200 repetitions; 20 % is four standard errors of an sd of 200.
TEST(Align, StandardDeviationsHold)
{
    const AlignReference reference(mesh_of(kBracket));
    std::vector<Twist> error;
    std::array<double, 6> predicted{};
    for (unsigned seed = 0; seed < 200; ++seed) {
        const OrientedPoints scan = scan_of(kBracket, 500, 0.1, seed);
        AlignOptions options;
        options.start = Eigen::Isometry3d::Identity();
        options.icp.max_distance = 2;
        const Alignment a = align(scan, reference, options);
        const Eigen::AngleAxisd turn(a.fit.T_reference_scan.linear());
        Twist x;
        x << a.fit.T_reference_scan * a.frame.centre - a.frame.centre, turn.angle() * turn.axis() * a.frame.radius;
        error.push_back(x);
        for (Eigen::Index k = 0; k < 6; ++k) {
            double variance = 0;
            for (const Freedom& freedom : a.freedoms) variance += std::pow(freedom.motion[k] * freedom.sd, 2);
            predicted[static_cast<std::size_t>(k)] += std::sqrt(variance) / 200;
        }
    }
    for (Eigen::Index k = 0; k < 6; ++k) {
        double square = 0;
        for (const Twist& x : error) square += x[k] * x[k] / 200;
        EXPECT_NEAR(std::sqrt(square) / predicted[static_cast<std::size_t>(k)], 1, 0.2);
    }
}

int determined(const Alignment& a)
{
    return static_cast<int>(
        std::count_if(a.freedoms.begin(), a.freedoms.end(), [](const Freedom& freedom) { return freedom.determined; }));
}

// A plane says nothing of three motions, a sphere of three, a cylinder of two: these stay as they were at the start,
// but for what the way of 0.5 makes of second order, 0.5²/50.
TEST(Align, WhatIsNotDeterminedStays)
{
    const auto surface = [](const std::string& kind) {
        Cloud cloud;
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
    for (const auto& [kind, sure] : {std::pair("plane", 3), std::pair("cylinder", 4), std::pair("sphere", 3)}) {
        const AlignReference reference(surface(kind));
        OrientedPoints scan = oriented_points(surface(kind));
        scan.xyz.row(2).array() += 0.5;
        AlignOptions options;
        options.start = Eigen::Isometry3d::Identity();
        const Alignment a = align(scan, reference, options);
        EXPECT_EQ(determined(a), sure) << kind;
        EXPECT_NEAR(a.fit.T_reference_scan.translation().z(), -0.5, 1e-3) << kind;
        EXPECT_NEAR((a.fit.T_reference_scan * a.frame.centre - a.frame.centre).head<2>().norm(), 0, 5e-3) << kind;
    }
}

TEST(Align, HeldAxesDoNotMove)
{
    const AlignReference reference(mesh_of(kBracket));
    OrientedPoints scan = scan_of(kBracket, 1500, 0.05, 1);
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()));
    AlignOptions options;
    options.icp.held = {false, false, true, true, true, false};
    const Alignment a = align(moved_by(turn, scan), reference, options);
    EXPECT_TRUE(a.fit.T_reference_scan.linear().col(2).isApprox(Eigen::Vector3d::UnitZ(), 1e-14));
    EXPECT_NEAR(a.fit.T_reference_scan.translation().z(), 0, 1e-12);
    EXPECT_LT(((a.fit.T_reference_scan * turn) * scan.xyz - scan.xyz).colwise().norm().maxCoeff(), 0.02);
    EXPECT_EQ(std::count_if(a.freedoms.begin(), a.freedoms.end(), [](const Freedom& f) { return f.held; }), 3);
}

// Two places that are as good are said to be so: a plain box turned by half a turn.
TEST(Align, SaysWhenAnotherPlaceIsAsGood)
{
    const std::vector<Box> box = {{{0, 0, 0}, {60, 40, 20}}};
    const Alignment a = align(scan_of(box, 1200, 0.1, 1), AlignReference(mesh_of(box)), {});
    ASSERT_TRUE(a.next);
    EXPECT_TRUE(ambiguous(a));
}

// The gradient against central differences.
TEST(Align, Gradient)
{
    const TwistFrame frame{{1, 2, 3}, 20};
    const Eigen::Vector3d point(11, -7, 5), direction = Eigen::Vector3d(1, -1, 2).normalized();
    const Twist g = frame.gradient(point, direction);
    for (Eigen::Index k = 0; k < 6; ++k) {
        constexpr double kStep = 1e-4; // rounding 1e-15 / 1e-4, truncation (1e-4)²
        const Twist x = kStep * Twist::Unit(k);
        const double up = direction.dot(frame.motion(x) * point), down = direction.dot(frame.motion(-x) * point);
        EXPECT_NEAR(g[k], (up - down) / (2 * kStep), 1e-8);
    }
}

// Shares of a distance list that is known: 70 % within 0.1, the rest far away.
TEST(Align, TrimFindsTheOverlap)
{
    Eigen::VectorXd closest = Eigen::VectorXd::LinSpaced(1000, 0.001, 0.1);
    closest.tail(300).setLinSpaced(5, 50);
    const Trim found = trim(closest, 1e-9);
    EXPECT_NEAR(static_cast<double>((closest.array() <= found.cut).count()), 700, 1);
    closest.head(700).setZero();
    EXPECT_EQ(trim(closest, 1e-9).cut, 0);
}

TEST(Align, TransformFilesKeepEveryBit)
{
    const OwnFolder folder;
    const Eigen::Matrix4d matrix = random_motion(7).matrix();
    std::ofstream file("T.txt");
    write_transform(file, matrix);
    file.close();
    EXPECT_EQ(read_transform("T.txt"), matrix);
}

TEST(Align, Refuses)
{
    const AlignReference reference(mesh_of(kBracket));
    OrientedPoints few{Eigen::Matrix3Xd::Random(3, 5), Eigen::Matrix3Xd::Zero(3, 5)};
    EXPECT_THROW(align(few, reference, {}), InputError);
    OrientedPoints one_place{Eigen::Matrix3Xd::Ones(3, 50), Eigen::Matrix3Xd::Zero(3, 50)};
    EXPECT_THROW(align(one_place, reference, {}), InputError);
    EXPECT_THROW(AlignReference(Cloud{}), InputError);
}

} // namespace
} // namespace fettle
