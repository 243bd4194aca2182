// Bounded least squares against every choice of bounds, and the conditions of the minimum on a large case.

#include "core/bounded_least_squares.h"
#include "core/error.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace fettle;

namespace bounded_least_squares_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The best of all 3^n choices of which unknowns are at a bound that give a point within the bounds.
double minimum_by_enumeration(const MatrixXd& A, const VectorXd& b, const VectorXd& lower, const VectorXd& upper)
{
    const Index n = A.cols();
    double min = std::numeric_limits<double>::infinity();
    for (int choice = 0; choice < std::pow(3, n); ++choice) {
        VectorXd x = VectorXd::Zero(n);
        std::vector<Index> free;
        for (Index k = 0, rest = choice; k < n; ++k, rest /= 3)
            if (rest % 3 == 0)
                free.push_back(k);
            else
                x[k] = rest % 3 == 1 ? lower[k] : upper[k];
        if (!free.empty()) {
            const MatrixXd F = A(Eigen::all, free);
            const VectorXd best = (F.transpose() * F).partialPivLu().solve(F.transpose() * (b - A * x));
            for (std::size_t i = 0; i < free.size(); ++i) x[free[i]] = best[static_cast<Index>(i)];
        }
        if ((x.array() >= lower.array() - 1e-12).all() && (x.array() <= upper.array() + 1e-12).all())
            min = std::min(min, (A * x - b).norm());
    }
    return min;
}

TEST(BoundedLeastSquares, IsTheBestOfAllChoices)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int run = 0; run < 20; ++run) {
        const MatrixXd A = MatrixXd::NullaryExpr(9, 5, [&] { return normal(random); });
        const VectorXd b = VectorXd::NullaryExpr(9, [&] { return 3 * normal(random); });
        const VectorXd lower = VectorXd::Constant(5, -0.3), upper = VectorXd::Constant(5, 0.8);
        const core::BoundedSolution found =
            core::bounded_least_squares(A.sparseView(), b, lower, upper, VectorXd::Zero(5), 1e-10);
        EXPECT_TRUE(found.converged);
        EXPECT_NEAR((A * found.x - b).norm(), minimum_by_enumeration(A, b, lower, upper), 1e-9);
    }
}

// Footprints like those of a wheel, each a bump over 40 of 4000 places, on an allowance that some of them cannot meet.
TEST(BoundedLeastSquares, MeetsTheConditionsOfTheMinimum)
{
    const Index places = 4000, points = 1000;
    std::vector<Eigen::Triplet<double>> entries;
    for (Index k = 0; k < points; ++k)
        for (Index i = std::max<Index>(0, 4 * k - 20); i < std::min(places, 4 * k + 20); ++i)
            entries.emplace_back(i, k, 1e-3 * (1 - std::pow(double(i - 4 * k) / 20.5, 2)) * (k % 3 + 1));
    Eigen::SparseMatrix<double> A(places, points);
    A.setFromTriplets(entries.begin(), entries.end());
    const VectorXd b = VectorXd::NullaryExpr(places, [](Index i) { return 0.4 + 0.4 * std::sin(double(i) / 30); });
    const VectorXd lower = VectorXd::Constant(points, 5), upper = VectorXd::Constant(points, 60);
    const core::BoundedSolution found = core::bounded_least_squares(A, b, lower, upper, lower, 1e-6);
    ASSERT_TRUE(found.converged);
    const VectorXd g = A.transpose() * (A * found.x - b), scale = VectorXd(A.transpose() * b);
    Index at_lower = 0, at_upper = 0;
    for (Index k = 0; k < points; ++k) {
        const bool low = found.x[k] <= lower[k], high = found.x[k] >= upper[k];
        at_lower += low;
        at_upper += high;
        const double allowed = low ? std::min(g[k], 0.0) : high ? std::max(g[k], 0.0) : g[k];
        EXPECT_LE(std::abs(allowed), 1e-5 * scale.maxCoeff());
    }
    EXPECT_GT(at_lower, 0);
    EXPECT_GT(at_upper, 0);
    EXPECT_LT(at_lower + at_upper, points);
    EXPECT_GE(found.x.minCoeff(), 5);
    EXPECT_LE(found.x.maxCoeff(), 60);
}

TEST(BoundedLeastSquares, FixesVariablesWithoutEffect)
{
    Eigen::SparseMatrix<double> A(2, 2);
    A.insert(0, 0) = 2;
    const core::BoundedSolution found = core::bounded_least_squares(A, Eigen::Vector2d(6, 1), Eigen::Vector2d(0, 0),
                                                                    Eigen::Vector2d(9, 9), Eigen::Vector2d(1, 7));
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.x[0], 3, 1e-9);
    EXPECT_EQ(found.x[1], 7);
    EXPECT_THROW(core::bounded_least_squares(A, Eigen::Vector2d(6, 1), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 9),
                                             Eigen::Vector2d(0, 0)),
                 core::InputError);
}

} // namespace bounded_least_squares_test
