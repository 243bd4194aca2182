// Contact of an elastic layer: Hertz where the layer is thick, Winkler where it is thin, the integral equation of the
// layer between, and what must hold for any contact.

#include "belt/layer_contact.h"
#include "core/error.h"
#include "layer_theory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace fettle;

namespace layer_contact_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kTightTolerance = 1e-8;

/// Gap between a plane and a paraboloid that touches it in the middle of the grid.
MatrixXd paraboloid(Index rows, Index columns, const Eigen::Vector2d& cell, double radius_x, double radius_y)
{
    MatrixXd gap(rows, columns);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i) {
            const double x = (static_cast<double>(2 * i - rows + 1) / 2) * cell.x();
            const double y = (static_cast<double>(2 * j - columns + 1) / 2) * cell.y();
            gap(i, j) = x * x / (2 * radius_x) + y * y / (2 * radius_y);
        }
    return gap;
}

double contact_radius(const belt::Contact& contact, double cell)
{
    return std::sqrt(static_cast<double>((contact.pressure.array() > 0).count()) / pi) * cell;
}

void expect_complementary(belt::LayerContact& layer, const MatrixXd& gap, const belt::Contact& contact)
{
    EXPECT_TRUE(contact.converged);
    EXPECT_GE(contact.pressure.minCoeff(), 0);
    const MatrixXd left = layer.residual_gap(gap, contact);
    EXPECT_GE(left.minCoeff(), 0);
    EXPECT_LE((contact.pressure.array() > 0).select(contact.pressure.array() * left.array(), 0).maxCoeff(),
              kTightTolerance * contact.pressure.maxCoeff() * (contact.indentation - gap.minCoeff()));
}

// Sphere of 8 mm on a half-space, 60 π N: a = 1.0096 mm, p0 = 88.29 MPa, δ = 0.1274 mm (Hertz 1881).
TEST(LayerContact, AgreesWithHertzOnAThickLayer)
{
    const double a = 1.0096, force = 60 * pi, young = 1000, poisson = 0.3;
    const belt::ElasticLayer layer{1000 * a, young, poisson};
    for (const Index n : {64, 128}) {
        const double cell = 3 * a / static_cast<double>(n);
        belt::LayerContact pressed(layer, {cell, cell}, n, n);
        const MatrixXd gap = paraboloid(n, n, {cell, cell}, 8, 8);
        const belt::Contact contact = pressed.solve_by_force(gap, force, kTightTolerance);
        expect_complementary(pressed, gap, contact);
        EXPECT_NEAR(contact.force, force, 1e-9 * force);
        EXPECT_NEAR(contact.pressure.maxCoeff(), 88.29, 0.01 * 88.29);
        EXPECT_NEAR(contact.indentation, 0.1274, 0.01 * 0.1274);
        if (n == 128) {
            EXPECT_NEAR(contact_radius(contact, cell), a, 0.01 * a);
        }
    }
}

// A cylinder of 20 mm along y: b = √(4F′R/πE*), p0 = 2F′/πb in the middle of a line much longer than b.
TEST(LayerContact, AgreesWithHertzOnALine)
{
    const double young = 1000, poisson = 0.3, modulus = young / (1 - poisson * poisson), per_length = 40;
    const double b = std::sqrt(4 * per_length * 20 / (pi * modulus)), p0 = 2 * per_length / (pi * b);
    constexpr Index kRows = 64, kColumns = 128;
    const Eigen::Vector2d cell(3 * b / kRows, b);
    const double infinite = std::numeric_limits<double>::infinity();
    const belt::Contact contact =
        belt::LayerContact({infinite, young, poisson}, cell, kRows, kColumns)
            .solve_by_force(paraboloid(kRows, kColumns, cell, 20, infinite), per_length * kColumns * cell.y(), 1e-6);
    const VectorXd middle = contact.pressure.col(kColumns / 2);
    const double here = middle.sum() * cell.x(); // the ends carry more than their share: 0.91 of the mean
    EXPECT_NEAR(middle.maxCoeff(), p0 * std::sqrt(here / per_length), 0.01 * p0);
    EXPECT_NEAR(static_cast<double>((middle.array() > 0).count()) * cell.x(), 2 * b * std::sqrt(here / per_length),
                2 * cell.x());
}

TEST(LayerContact, TheoryIsHertzWithoutAHub)
{
    const LayerTheory theory = layer_theory({1e6, 1000, 0.3}, 1.0096, 8);
    EXPECT_NEAR(theory.force, 60 * pi, 0.001 * 60 * pi);
    EXPECT_NEAR(theory.indentation, 0.1274, 1e-4);
    EXPECT_NEAR(theory.peak, 88.29, 0.05);
}

TEST(LayerContact, AgreesWithLayerTheory)
{
    constexpr Index kCells = 96;
    const double a = 4, R = 60, cell = 3 * a / kCells;
    for (const double poisson : {0.0, 0.3, 0.45, 0.49})
        for (const double thickness : {1.0, 2.0, 4.0, 10.0}) {
            const belt::ElasticLayer layer{thickness * a, 5, poisson};
            const LayerTheory theory = layer_theory(layer, a, R);
            const belt::Contact contact =
                belt::LayerContact(layer, {cell, cell}, kCells, kCells)
                    .solve_by_force(paraboloid(kCells, kCells, {cell, cell}, R, R), theory.force, 1e-6);
            EXPECT_NEAR(contact.indentation, theory.indentation, 0.02 * theory.indentation);
            EXPECT_NEAR(contact.pressure.maxCoeff(), theory.peak, 0.02 * theory.peak);
            EXPECT_NEAR(contact_radius(contact, cell), a, 0.02 * a);
        }
}

// p = E(1-ν) / ((1+ν)(1-2ν)) w/h where the contact is much wider than the layer is thick.
TEST(LayerContact, AgreesWithWinklerOnAThinLayer)
{
    constexpr Index kCells = 96;
    const double a = 20, R = 400, cell = 2.5 * a / kCells, depth = a * a / (2 * R);
    for (const double poisson : {0.0, 0.3})
        for (const double thickness : {a / 10, a / 30, a / 1000}) {
            const belt::ElasticLayer layer{thickness, 5, poisson};
            const double stiffness = 1 / uniform_compliance(layer);
            belt::LayerContact pressed(layer, {cell, cell}, kCells, kCells);
            const MatrixXd gap = paraboloid(kCells, kCells, {cell, cell}, R, R);
            const belt::Contact contact = pressed.solve_by_indentation(gap, depth, kTightTolerance);
            expect_complementary(pressed, gap, contact);
            EXPECT_NEAR(contact.pressure.maxCoeff(), stiffness * depth, 0.02 * stiffness * depth);
        }
}

// For any surface: scattered peaks, a step, cells without material.
TEST(LayerContact, IsComplementary)
{
    constexpr Index kCells = 48;
    MatrixXd gap = paraboloid(kCells, kCells, {0.5, 0.5}, 100, 300);
    for (Index j = 0; j < kCells; ++j)
        for (Index i = 0; i < kCells; ++i) gap(i, j) += 0.2 * std::sin(1.7 * double(i)) * std::cos(0.9 * double(j));
    gap.rightCols(kCells / 2).array() += 0.3;
    gap.topRows(20).setConstant(std::numeric_limits<double>::infinity());
    for (const double poisson : {0.0, 0.49})
        for (const double thickness : {1.0, 15.0}) {
            belt::LayerContact contact({thickness, 5, poisson}, {0.5, 0.5}, kCells, kCells);
            const belt::Contact pressed = contact.solve_by_force(gap, 40, kTightTolerance);
            expect_complementary(contact, gap, pressed);
            EXPECT_EQ(pressed.pressure.topRows(20).maxCoeff(), 0);
            // To the same depth the same force; from the start of another the same contact.
            const belt::Contact deep = contact.solve_by_indentation(gap, pressed.indentation, kTightTolerance);
            // A surface 3 mm higher is touched 3 mm earlier.
            EXPECT_NEAR(contact.solve_by_force(gap.array() - 3, 40, kTightTolerance).indentation,
                        pressed.indentation - 3, 1e-6);
            EXPECT_NEAR(deep.force, 40, 1e-5 * 40);
            const belt::Contact again =
                contact.solve_by_force(gap, 40, kTightTolerance, contact.solve_by_force(gap, 10, 1e-3).pressure);
            EXPECT_LE((again.pressure - pressed.pressure).cwiseAbs().maxCoeff(), 1e-5 * pressed.pressure.maxCoeff());
        }
}

// While a belt grinds, the gap with what it removes is complementary to the pressure, by any law.
TEST(LayerContact, MakesRoomByWhatIsRemoved)
{
    const Index n = 48;
    belt::LayerContact contact({10, 5, 0.45}, {0.5, 0.5}, n, n);
    const MatrixXd gap = paraboloid(n, n, {0.5, 0.5}, 40, 60);
    for (const belt::RemovalStep& removal :
         {belt::RemovalStep{0.3, 1, 0}, belt::RemovalStep{0.5, 2.3, 0}, belt::RemovalStep{0.4, 1.2, 0.05}}) {
        const belt::Contact found = contact.solve_by_force(gap, 40, kTightTolerance, {}, removal);
        ASSERT_TRUE(found.converged);
        const MatrixXd depth = found.pressure.unaryExpr([&](double p) { return removal.depth(p); });
        const belt::Contact still = contact.solve_by_force(gap + depth, 40, kTightTolerance);
        EXPECT_LE((still.pressure - found.pressure).cwiseAbs().maxCoeff(), 1e-4 * found.pressure.maxCoeff());
        EXPECT_NEAR(still.indentation, found.indentation, 1e-5 * found.indentation);
        EXPECT_LT(found.pressure.maxCoeff(), contact.solve_by_force(gap, 40, 1e-4).pressure.maxCoeff());
    }
}

// On a rippled surface, starts extrapolated from forces that fell from 40 to 10 N led round in circles.
TEST(LayerContact, BeginsAnewWhereAStartLeadsNowhere)
{
    const Index cells = 24;
    const double side = 9.0 / cells;
    belt::LayerContact contact({3, 1.8, 0.45}, {side, side}, cells, cells);
    MatrixXd gap(cells, cells);
    for (Index j = 0; j < cells; ++j)
        for (Index i = 0; i < cells; ++i) {
            const double x = (double(i) + 0.5) * side - 4.5, y = (double(j) + 0.5) * side - 4.5;
            gap(i, j) = x * x / 80 + y * y / 30 + 0.02 * std::sin(3 * x + 1) * std::cos(2.3 * y);
        }
    const MatrixXd hard = contact.solve_by_force(gap, 40, 1e-4).pressure,
                   soft = contact.solve_by_force(gap, 10, 1e-4).pressure;
    for (const double force : {1.0, 5.0, 25.0}) {
        const belt::Contact found = contact.solve_by_force(gap, force, 1e-4, 2 * soft - hard);
        const belt::Contact fresh = contact.solve_by_force(gap, force, 1e-4);
        EXPECT_TRUE(found.converged);
        EXPECT_NEAR(found.indentation, fresh.indentation, 1e-3 * fresh.indentation);
    }
}

TEST(LayerContact, KnowsWhenNothingTouches)
{
    belt::LayerContact contact({10, 5, 0.45}, {1, 1}, 16, 16);
    const MatrixXd gap = MatrixXd::Constant(16, 16, 2.0);
    EXPECT_EQ(contact.solve_by_indentation(gap, 1.5, kTightTolerance).force, 0);
    EXPECT_EQ(contact.residual_gap(gap, contact.solve_by_indentation(gap, 1.5, kTightTolerance))(3, 4), 0.5);
    EXPECT_THROW(contact.solve_by_force(gap / 0.0, 1, kTightTolerance), core::InputError);
    EXPECT_THROW(belt::influence_coefficients({10, 5, 0.6}, {1, 1}, 4, 4), core::InputError);
}

} // namespace layer_contact_test
