#include "geometry/local_quadratic.h"

#include <gtest/gtest.h>

namespace fettle {
namespace local_quadratic_test {

using geometry::QuadraticTerms;

// Two quadratics at once through a lattice of 25 points, one of them far off but without weight.
TEST(LocalQuadratic, QuadraticsAreReproduced)
{
    Eigen::Matrix<double, 6, 2> expected;
    expected << 1, 4, -2, 0.5, 0.3, 0, 0.7, -1, -0.2, 2, 0.4, 3;
    geometry::QuadraticEquations<2> equations;
    for (int i = 0; i < 25; ++i) {
        const QuadraticTerms terms = geometry::quadratic_terms(0.5 * (i % 5) - 1, 0.5 * (i / 5) - 1);
        const bool is_outlier = i == 7;
        const Eigen::Vector2d values = expected.transpose() * terms + Eigen::Vector2d::Constant(is_outlier ? 9 : 0);
        equations.add_point(terms, values, is_outlier ? 0 : 1 + i % 3);
    }
    const auto fit = equations.solve();
    ASSERT_TRUE(fit);
    EXPECT_LE((fit->coefficients - expected).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GT(fit->pivots.minCoeff(), 0.1);
}

// On a line a quadratic is undetermined: no solution, or a pivot of rounding size.
TEST(LocalQuadratic, PivotsShowCollinearPoints)
{
    geometry::QuadraticEquations<1> equations;
    for (int i = 0; i < 9; ++i)
        equations.add_point(geometry::quadratic_terms(0.1 * i, 0.3 * i), Eigen::Matrix<double, 1, 1>(i));
    const auto fit = equations.solve();
    EXPECT_TRUE(!fit || fit->pivots.minCoeff() < 1e-6);
}

TEST(LocalQuadratic, WidestGapBetweenDirections)
{
    EXPECT_NEAR(geometry::widest_gap({0.5}), 2 * std::numbers::pi, 1e-14);
    EXPECT_NEAR(geometry::widest_gap({3, -3, 1, -1}), 2, 1e-15);
    EXPECT_NEAR(geometry::widest_gap({1, -1}), 2 * std::numbers::pi - 2, 1e-14); // across the cut at π
}

} // namespace local_quadratic_test
} // namespace fettle
