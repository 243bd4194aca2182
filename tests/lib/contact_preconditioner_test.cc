// The preconditioner of a layer's contact: close for the longest and the shortest waves, symmetric and positive
// definite on any part of the cells; with it, a contact takes fewer iterations than it would with the gradient alone.

#include "belt/contact_preconditioner.h"
#include "belt/layer_compliance.h"
#include "belt/layer_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace fettle;

namespace contact_preconditioner_test {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

constexpr Index kRows = 40, kColumns = 24;
const Eigen::Vector2d kCell(0.5, 0.25);

MatrixXd influence(double thickness, double poisson)
{
    return belt::influence_coefficients({thickness, 5, poisson}, kCell, kRows, kColumns);
}

/// Displacement at the crest of a wave with these phases from row to row and from column to column, cell by cell.
double displacement_at_crest(const MatrixXd& influence, double row_phase, double column_phase)
{
    double sum = 0;
    for (Index j = 1 - kColumns; j < kColumns; ++j)
        for (Index i = 1 - kRows; i < kRows; ++i)
            sum += influence(std::abs(i), std::abs(j)) * std::cos(row_phase * double(i)) *
                   std::cos(column_phase * double(j));
    return sum;
}

TEST(ContactPreconditioner, DividesTheLongestAndTheShortestWavesByTheirCompliance)
{
    const MatrixXd layer = influence(10, 0.45);
    belt::ContactPreconditioner preconditioner(layer);
    for (const double own : {0.0, 0.02}) {
        preconditioner.fit(own);
        for (const bool short_rows : {false, true})
            for (const bool short_columns : {false, true}) {
                ArrayXXd wave(kRows, kColumns);
                for (Index j = 0; j < kColumns; ++j)
                    for (Index i = 0; i < kRows; ++i)
                        wave(i, j) = (short_rows && i % 2 == 1 ? -1 : 1) * (short_columns && j % 2 == 1 ? -1 : 1);
                const double compliance = displacement_at_crest(layer, short_rows ? pi : pi / double(kRows),
                                                                short_columns ? pi : pi / double(kColumns));
                // Away from the border, where the stencil lies on cells without a gap.
                const ArrayXXd ratio =
                    (preconditioner(wave) / wave).block(1, 1, kRows - 2, kColumns - 2) * (compliance + own);
                EXPECT_NEAR(ratio.minCoeff(), 1, 0.2); // its influence falls off towards the ends of the window
                EXPECT_NEAR(ratio.maxCoeff(), ratio.minCoeff(), 1e-12);
            }
    }
}

TEST(ContactPreconditioner, IsSymmetricAndPositiveDefiniteOnAnyCells)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto gaps = [&] { return ArrayXXd::NullaryExpr(kRows, kColumns, [&] { return uniform(random); }).eval(); };
    for (const double thickness : {0.1, 1.0, 10.0, 1e3})
        for (const double poisson : {0.0, 0.45, 0.5}) {
            belt::ContactPreconditioner preconditioner(influence(thickness, poisson));
            for (const double own : {0.0, 0.1})
                for (const double share : {0.01, 0.5, 1.0}) {
                    preconditioner.fit(own);
                    const ArrayXXd cells = (gaps().abs() <= share).cast<double>(), a = cells * gaps(),
                                   b = cells * gaps();
                    const double product = (a * preconditioner(b)).sum(), energy = (a * preconditioner(a)).sum();
                    EXPECT_GT(energy, 0);
                    EXPECT_NEAR((b * preconditioner(a)).sum(), product, 1e-12 * energy);
                }
        }
}

TEST(ContactPreconditioner, LeavesWavesAsTheyAreWithoutALayer)
{
    const belt::ContactPreconditioner preconditioner;
    const ArrayXXd any = ArrayXXd::Random(7, 5);
    EXPECT_LE((preconditioner(any) - any).abs().maxCoeff(), 1e-15);
}

// Without preconditioning these took 15, 20, 22 and 15 iterations.
TEST(ContactPreconditioner, SavesIterations)
{
    constexpr Index kCells = 64;
    MatrixXd gap(kCells, kCells);
    for (Index j = 0; j < kCells; ++j)
        for (Index i = 0; i < kCells; ++i) {
            const double x = 0.5 * (double(i) - 31.5), y = 0.5 * (double(j) - 31.5);
            gap(i, j) = x * x / 200 + y * y / 50;
        }
    constexpr double kTolerance = 1e-6;
    belt::LayerContact contact({10, 5, 0.45}, {0.5, 0.5}, kCells, kCells);
    EXPECT_LE(contact.solve_by_force(gap, 20, kTolerance).iterations, 12);
    EXPECT_LE(contact.solve_by_force(gap, 100, kTolerance).iterations, 14);
    EXPECT_LE(contact.solve_by_indentation(gap, 1, kTolerance).iterations, 12);
    EXPECT_LE(contact.solve_by_force(gap, 20, kTolerance, {}, {0.1, 2.25, 0}).iterations, 12);
}

} // namespace contact_preconditioner_test
