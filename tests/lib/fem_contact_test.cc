// Contacts of the finite elements' layer against layer theory, Hertz, an active set, and the Fourier layer.

#include "belt/fem_layer.h"
#include "belt/press.h"
#include "layer_theory.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

using namespace fettle;

namespace fem_contact_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kTightTolerance = 1e-8;

MatrixXd paraboloid(Index n, double cell, double radius)
{
    const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) - double(n - 1) / 2) * cell;
    return (x.square().replicate(1, n) + x.square().transpose().replicate(n, 1)) / (2 * radius);
}

/// A flat layer wide enough that its sides have no influence.
belt::LayerContact flat(const belt::ElasticLayer& layer, double cell, Index cells, Index elements)
{
    return {belt::layer_mesh(layer, 1e6 * layer.thickness, 20 * layer.thickness, {cell, cell}, cells, elements), cells};
}

struct Errors {
    double indentation, peak;
};

Errors against_theory(double poisson, double thickness, Index cells, Index elements)
{
    const double a = 4, R = 60, cell = 3 * a / static_cast<double>(cells);
    const belt::ElasticLayer layer{thickness * a, 5, poisson};
    const LayerTheory theory = layer_theory(layer, a, R);
    const belt::Contact contact =
        flat(layer, cell, cells, elements).solve_by_force(paraboloid(cells, cell, R), theory.force, kTightTolerance);
    EXPECT_TRUE(contact.converged);
    EXPECT_NEAR(contact.force, theory.force, 1e-9 * theory.force);
    return {contact.indentation / theory.indentation - 1, contact.pressure.maxCoeff() / theory.peak - 1};
}

// No locking: as near at ν = 0.5 as at 0.3, on 16 x 16 cells and four elements through the depth.
TEST(FemContact, DoesNotLock)
{
    for (const double thickness : {1.0, 2.0, 4.0}) {
        const Errors soft = against_theory(0.3, thickness, 16, 4);
        for (const double poisson : {0.45, 0.49, 0.499, 0.4999, 0.5}) {
            const Errors error = against_theory(poisson, thickness, 16, 4);
            EXPECT_NEAR(error.indentation, soft.indentation, 0.006);
            EXPECT_NEAR(error.peak, soft.peak, 0.006);
        }
    }
}

TEST(FemContact, AgreesWithLayerTheory)
{
    for (const double poisson : {0.0, 0.3, 0.45, 0.499})
        for (const double thickness : {1.0, 2.0, 4.0}) {
            const Errors error = against_theory(poisson, thickness, 32, 8);
            EXPECT_LE(std::abs(error.indentation), 0.005);
            EXPECT_LE(std::abs(error.peak), 0.005);
        }
}

// Convergence is of second order: half the elements' sides, a quarter of the error.
TEST(FemContact, ConvergesToLayerTheory)
{
    for (const double poisson : {0.3, 0.499}) {
        const double coarse = against_theory(poisson, 4, 16, 4).indentation;
        const double fine = against_theory(poisson, 4, 32, 8).indentation;
        EXPECT_GE(std::log2(coarse / fine), 1.8);
        EXPECT_GE(std::log2(fine / against_theory(poisson, 4, 64, 16).indentation), 1.8);
    }
}

// Sphere of 8 mm, 60 π N, a hub 1000 contact radii below (Hertz 1881, as in layer_contact_test.cc).
TEST(FemContact, AgreesWithHertzOnAThickLayer)
{
    const double a = 1.0096, peak = 88.29, approach = 0.1274;
    const auto error = [&](Index cells, Index elements) {
        const double cell = 3 * a / static_cast<double>(cells);
        const belt::Contact contact = flat({1000 * a, 1000, 0.3}, cell, cells, elements)
                                          .solve_by_force(paraboloid(cells, cell, 8), 60 * pi, kTightTolerance);
        return Errors{contact.indentation / approach - 1, contact.pressure.maxCoeff() / peak - 1};
    };
    const Errors coarse = error(16, 8), fine = error(32, 16);
    EXPECT_LE(std::abs(fine.indentation), 0.01);
    EXPECT_LE(std::abs(fine.peak), 0.01);
    EXPECT_GE(std::log2(coarse.indentation / fine.indentation), 1.8);
    EXPECT_GE(std::log2(coarse.peak / fine.peak), 1.8);
}

// A wheel pressed across its whole width: of second order too, its pressure at the edges finite. The layer without
// edges is a quarter too stiff, and its pressure at the edges grows as the cells get smaller; with them
// (EdgeCompliance) it is the elements' to 3 %.
TEST(FemContact, ConvergesAcrossTheWholeWidth)
{
    const belt::ElasticLayer rubber{6, 5, 0.49};
    const double width = 20, radius = 60;
    const auto pressed = [&](Index cells, auto make) {
        const Eigen::Vector2d cell(16.0 / static_cast<double>(cells), width / static_cast<double>(cells));
        const Eigen::ArrayXd x = (Eigen::ArrayXd::LinSpaced(cells, 1, 2 * double(cells) - 1) - double(cells)) / 2;
        const MatrixXd gap = ((x * cell.x()).square() / 80).matrix().replicate(1, cells);
        return make(cell).solve_by_force(gap, 200, kTightTolerance);
    };
    const auto fem = [&](Index cells) {
        return pressed(cells, [&](const Eigen::Vector2d& cell) {
            return belt::LayerContact(belt::layer_mesh(rubber, radius, width, cell, cells, cells / 8), cells);
        });
    };
    const belt::Contact coarse = fem(16), middle = fem(32), fine = fem(64);
    EXPECT_GT(fine.pressure.col(0).minCoeff(), -1e-12);
    EXPECT_GT(fine.pressure.col(0).maxCoeff(), 0);
    EXPECT_GE(std::log2((middle.indentation - coarse.indentation) / (fine.indentation - middle.indentation)), 1.7);
    EXPECT_NEAR(middle.pressure.maxCoeff(), fine.pressure.maxCoeff(), 0.01 * fine.pressure.maxCoeff());
    const belt::Contact edgeless =
        pressed(64, [&](const Eigen::Vector2d& cell) { return belt::LayerContact(rubber, cell, 64, 64); });
    EXPECT_LT(edgeless.indentation, 0.8 * fine.indentation);
    EXPECT_GT(edgeless.pressure.maxCoeff(), 2 * fine.pressure.maxCoeff());
    const belt::EdgeCompliance edges(rubber, radius, width);
    const belt::Contact layer =
        pressed(64, [&](const Eigen::Vector2d& cell) { return belt::LayerContact(rubber, edges, cell, 64, 64); });
    EXPECT_NEAR(layer.indentation, fine.indentation, 0.03 * fine.indentation);
    EXPECT_NEAR(layer.pressure.maxCoeff(), fine.pressure.maxCoeff(), 0.03 * fine.pressure.maxCoeff());
    EXPECT_LE((layer.pressure - fine.pressure).norm(), 0.03 * fine.pressure.norm());
}

/// On a small wheel, under its edge, where nothing is under a corner of the window.
belt::LayerMesh at_the_edge() { return belt::layer_mesh({6, 5, 0.49}, 40, 16, {1, 1}, 16, 4); }

MatrixXd rough_gap()
{
    MatrixXd gap = paraboloid(16, 1, 30).rowwise().reverse();
    for (Index i = 0; i < 16; ++i)
        for (Index j = 0; j < 16; ++j) gap(i, j) += 0.1 * std::sin(1.7 * double(i)) * std::cos(0.9 * double(j));
    gap.topLeftCorner(9, 3).setConstant(std::numeric_limits<double>::infinity());
    return gap.array() - Eigen::ArrayXd::LinSpaced(16, 0, 4).transpose().replicate(16, 1);
}

// Pressure and gap are not negative, and one of them is 0, at once along the radii and summed up along the middle's.
TEST(FemContact, IsComplementary)
{
    belt::LayerContact contact(at_the_edge(), 16);
    const belt::FemLayer layer(at_the_edge(), 16);
    const MatrixXd gap = rough_gap();
    const belt::Contact pressed = contact.solve_by_force(gap, 40, kTightTolerance);
    ASSERT_TRUE(pressed.converged);
    EXPECT_GE(pressed.pressure.minCoeff(), 0);
    EXPECT_EQ(pressed.pressure.topLeftCorner(9, 3).maxCoeff(), 0);
    EXPECT_GT(pressed.pressure.col(15).maxCoeff(), 0);                                        // the edge is in it
    EXPECT_NEAR((pressed.pressure.array().colwise() * layer.tilt_cosines()).sum(), 40, 1e-9); // cells of 1 mm²
    const double max = kTightTolerance * pressed.pressure.maxCoeff() * (pressed.indentation - gap.minCoeff());
    const MatrixXd left = contact.residual_gap(gap, pressed);
    EXPECT_LE((pressed.pressure.array() > 0).select(pressed.pressure.array() * left.array(), 0).maxCoeff(), max);
    const MatrixXd open = gap + layer.displacement(pressed.pressure) -
                          pressed.indentation * layer.tilt_cosines().matrix().replicate(1, 16);
    EXPECT_GE(open.minCoeff(), -2 * kTightTolerance * (pressed.indentation - gap.minCoeff()));
    EXPECT_NEAR(contact.solve_by_indentation(gap, pressed.indentation, kTightTolerance).force, 40, 1e-5);
    EXPECT_EQ(contact.solve_by_indentation(gap, gap.minCoeff() - 1, kTightTolerance).force, 0);
    const belt::Contact again =
        contact.solve_by_force(gap, 40, kTightTolerance, contact.solve_by_force(gap, 10, 1e-3).pressure);
    EXPECT_LE((again.pressure - pressed.pressure).cwiseAbs().maxCoeff(), 1e-5 * pressed.pressure.maxCoeff());
}

// Reference: an independent method, an active set, eliminated again until it no longer changes (Hintermüller, Ito and
// Kunisch 2003).
TEST(FemContact, IsTheActiveSets)
{
    belt::LayerContact contact(at_the_edge(), 16);
    const belt::FemLayer layer(at_the_edge(), 16);
    const MatrixXd gap = rough_gap();
    const double depth = gap.minCoeff() + 0.8;
    MatrixXd S(256, 256);
    for (Index k = 0; k < 256; ++k) S.col(k) = layer.displacement(VectorXd::Unit(256, k).reshaped(16, 16)).reshaped();
    const VectorXd wanted = (depth * layer.tilt_cosines().matrix().replicate(1, 16) - gap).reshaped();
    VectorXd pressure = VectorXd::Zero(256);
    std::vector<Index> active, before;
    for (Index k = 0; k < 256; ++k)
        if (wanted[k] > 0) active.push_back(k);
    for (int step = 0; step < 50 && active != before; ++step) {
        const MatrixXd A = S(active, active);
        pressure.setZero();
        const VectorXd depths = wanted(active), pressed = A.llt().solve(depths);
        pressure(active) = pressed;
        const VectorXd cross = wanted - S * pressure;
        before = std::exchange(active, {});
        for (Index k = 0; k < 256; ++k)
            if (pressure[k] > 0 || (pressure[k] == 0 && cross[k] > 0)) active.push_back(k);
    }
    ASSERT_EQ(active, before);
    const belt::Contact found = contact.solve_by_indentation(gap, depth, kTightTolerance);
    EXPECT_LE((found.pressure.reshaped() - pressure).cwiseAbs().maxCoeff(), 1e-5 * pressure.maxCoeff());
}

/// Surfels of a blade's skin, radii along x and y, as wide as the wheel finds it.
belt::Surfels blade(double radius_x, double radius_y)
{
    constexpr Index kSide = 121;
    constexpr double kSpacing = 0.5;
    belt::Surfels surfels;
    surfels.position.resize(3, kSide * kSide);
    surfels.normal.resize(3, kSide * kSide);
    for (Index i = 0; i < kSide; ++i)
        for (Index j = 0; j < kSide; ++j) {
            const double x = (double(i) - (kSide - 1) / 2.0) * kSpacing, y = (double(j) - (kSide - 1) / 2.0) * kSpacing;
            surfels.position.col(i * kSide + j) << x, y, -x * x / (2 * radius_x) - y * y / (2 * radius_y);
            surfels.normal.col(i * kSide + j) = Vector3d(x / radius_x, y / radius_y, 1).normalized();
        }
    surfels.radius.setConstant(kSide * kSide, kSpacing);
    surfels.displacement.setZero(kSide * kSide);
    surfels.uv.setZero(2, kSide * kSide);
    surfels.patch.setZero(kSide * kSide);
    return surfels;
}

// On a curved blade the Fourier layer, which is flat, and the round layer's elements agree to 3 % where h/R ≤ 0.1: the
// blade's edge under the wheel, its back, and a hollow.
TEST(FemContact, AgreesWithTheFourierLayerOnABlade)
{
    belt::ContactWheel wheel;
    wheel.radius = 100;
    wheel.width = 200;
    for (const auto& [radius_x, radius_y] : {std::pair(20, 300), std::pair(300, 20), std::pair(-400, 60)})
        for (const double poisson : {0.3, 0.49}) {
            wheel.layer = {10, 5, poisson};
            const belt::Surfels surfels = blade(radius_x, radius_y);
            belt::WheelContactOptions options;
            belt::WheelContactSolver layer(surfels, wheel, options);
            options.solver = belt::LayerSolver::fem;
            belt::WheelContactSolver fem(surfels, wheel, options);
            const belt::WheelContact& one = layer.solve(Eigen::Isometry3d::Identity(), {true, 60});
            const belt::WheelContact& other = fem.solve(Eigen::Isometry3d::Identity(), {true, 60});
            EXPECT_NEAR(other.contact.indentation, one.contact.indentation, 0.03 * one.contact.indentation);
            EXPECT_NEAR(other.contact.pressure.maxCoeff(), one.contact.pressure.maxCoeff(),
                        0.03 * one.contact.pressure.maxCoeff());
            EXPECT_FALSE(other.is_near_edge);
            EXPECT_EQ(other.arc_radius, 100);
            // The contact lies where the layer's does: on the blade.
            const cloud::Cloud cloud = belt::to_cloud(other, fem.residual_gap(), Eigen::Isometry3d::Identity());
            const Eigen::ArrayXd x = cloud.xyz.row(0), y = cloud.xyz.row(1), z = cloud.xyz.row(2);
            const double off = (z + x.square() / (2 * radius_x) + y.square() / (2 * radius_y)).abs().maxCoeff();
            EXPECT_LE(off, 0.02);
        }
}

// A path that goes on from where it was left finds the elements' grid again.
TEST(FemContact, GoesOnFromWhatItRemembers)
{
    belt::ContactWheel wheel;
    wheel.radius = 60;
    wheel.width = 40;
    wheel.layer = {6, 5, 0.49};
    const belt::Surfels surfels = blade(100, 60);
    belt::WheelContactOptions options;
    options.solver = belt::LayerSolver::fem;
    options.cells_per_side = 24;
    options.elements = 4;
    belt::WheelContactSolver one(surfels, wheel, options), other(surfels, wheel, options);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    EXPECT_NEAR(one.solve(pose, {true, 20}).contact.force, 20, 1e-9);
    other.restore(one.state());
    pose.rotate(Eigen::AngleAxisd(0.01, Vector3d::UnitX()));
    const MatrixXd expected = one.solve(pose, {true, 21}).contact.pressure;
    EXPECT_EQ(other.solve(pose, {true, 21}).contact.pressure, expected);
    EXPECT_EQ(other.solve(pose, {true, 21}).arc_radius, 60);
}

TEST(FemContact, DoesNotDependOnTheThreads)
{
    const MatrixXd pressure = rough_gap().array().isFinite().select(rough_gap().array().abs(), 0);
    std::vector<MatrixXd> displacements;
    for (const std::size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        displacements.push_back(belt::FemLayer(at_the_edge(), 16).displacement(pressure));
    }
    EXPECT_EQ(displacements[0], displacements[1]);
}

} // namespace fem_contact_test
