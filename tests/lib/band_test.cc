#include "surface/band.h"

#include "core/error.h"
#include "surface/spline_energy.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fettle {
namespace band_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd dense(const surface::BandMatrix& band)
{
    MatrixXd full = MatrixXd::Zero(band.size(), band.size());
    for (Index i = 0; i < band.size(); ++i)
        for (Index j = std::max<Index>(0, i - band.half_bandwidth()); j <= i; ++j) full(i, j) = full(j, i) = band(i, j);
    return full;
}

surface::BandMatrix some_band(Index size, Index half)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    surface::BandMatrix band(size, half);
    for (Index i = 0; i < size; ++i) {
        for (Index j = std::max<Index>(0, i - band.half_bandwidth()); j < i; ++j) band(i, j) = number(random);
        band(i, i) = 2 * static_cast<double>(half) + 1; // dominates its row: positive definite
    }
    return band;
}

// Reference: Eigen's dense factorisation.
TEST(BandCholesky, AgreesWithDense)
{
    for (const auto& [size, half] :
         {std::pair<Index, Index>{1, 0}, {2, 5}, {7, 0}, {8, 2}, {30, 7}, {31, 12}, {50, 49}}) {
        const surface::BandMatrix band = some_band(size, half);
        const MatrixXd full = dense(band);
        const VectorXd b = VectorXd::LinSpaced(size, -1, 3);
        const surface::BandCholesky factor(band);
        EXPECT_LT((band * b - full * b).norm(), 1e-12);
        EXPECT_LT((factor.solve(b) - full.llt().solve(b)).norm(), 1e-13) << size << ' ' << half;
        EXPECT_NEAR(factor.solve_lower(b).squaredNorm(), b.dot(full.llt().solve(b)), 1e-13);
        EXPECT_NEAR(factor.log_determinant(), std::log(full.determinant()), 1e-10);
        const MatrixXd inverse = full.inverse();
        const surface::BandMatrix inside = factor.inverse_in_band();
        for (Index i = 0; i < size; ++i)
            for (Index j = std::max<Index>(0, i - band.half_bandwidth()); j <= i; ++j)
                EXPECT_NEAR(inside(i, j), inverse(i, j), 1e-14) << size << ' ' << half;
        EXPECT_NEAR(band.trace(), full.trace(), 1e-12);
    }
}

// A right side that begins with zeros.
TEST(BandCholesky, StartsWhereTheRightSideDoes)
{
    const surface::BandMatrix band = some_band(40, 6);
    VectorXd b = VectorXd::Zero(40);
    b.tail(12).setOnes();
    EXPECT_LT((surface::BandCholesky(band).solve(b) - dense(band).llt().solve(b)).norm(), 1e-13);
}

TEST(BandCholesky, RefusesWhatIsNotPositiveDefinite)
{
    surface::BandMatrix band = some_band(9, 3);
    band(5, 5) = -1;
    EXPECT_THROW(surface::BandCholesky{band}, core::InputError);
}

// u³/6 and u v²/2 have one third derivative each that is not 0: 1, counted once and three times.
TEST(SplineEnergy, OfPolynomials)
{
    surface::Bspline grid{0, {0, 0}, {2, 3}, MatrixXd::Zero(7, 6)}; // 4 x 3 cells: a = 8, b = 9
    const double a = 8, b = 9;
    // Control heights of u³ and of u v² by Marsden's identity: g, g² - h²/3, g (g² - h²).
    MatrixXd cubic(7, 6), mixed(7, 6);
    for (Index j = 0; j < 6; ++j)
        for (Index i = 0; i < 7; ++i) {
            const double u = 2.0 * (static_cast<double>(i) - 1), v = 3.0 * (static_cast<double>(j) - 1);
            cubic(i, j) = u * (u * u - 4) / 6;
            mixed(i, j) = u * (v * v - 3) / 2;
        }
    surface::BandMatrix K = surface::zero_band_matrix(grid);
    surface::add_derivative_energy(K, grid, 1);
    const auto energy = [&](const MatrixXd& heights) {
        const VectorXd c = heights.reshaped();
        return c.dot(K * c);
    };
    EXPECT_NEAR(energy(cubic), a * b, 1e-9);
    EXPECT_NEAR(energy(mixed), 3 * a * b, 1e-9);
    const MatrixXd known = surface::quadratic_control_heights(grid).heights;
    for (Index k = 0; k < known.cols(); ++k) EXPECT_LT((K * VectorXd(known.col(k))).norm(), 1e-12 * K.trace());
}

// Points on the Gauss lattice of the cells are as good as evenly spread ones.
TEST(SplineEnergy, UniformPoints)
{
    surface::Bspline grid{0.3, {1, 2}, {2, 3}, MatrixXd::Zero(5, 6)};
    const MatrixXd weights = MatrixXd::Random(2, 3).cwiseAbs();
    surface::BandMatrix sum = surface::zero_band_matrix(grid);
    surface::add_cell_weights(sum, grid, weights);
    constexpr double kNode[] = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258};
    constexpr double kWeight[] = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
    MatrixXd expected = MatrixXd::Zero(30, 30);
    for (Index row = 0; row < 2; ++row)
        for (Index column = 0; column < 3; ++column)
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j) {
                    const Eigen::Vector2d uv(static_cast<double>(row) + (1 + kNode[i]) / 2,
                                             static_cast<double>(column) + (1 + kNode[j]) / 2);
                    const Eigen::Vector2d xy =
                        grid.origin + Eigen::Rotation2Dd(grid.angle) * uv.cwiseProduct(grid.cell);
                    const VectorXd g = surface::height_gradients(grid, xy);
                    expected += weights(row, column) * kWeight[i] * kWeight[j] / 4 * g * g.transpose();
                }
    EXPECT_LT((dense(sum) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

} // namespace band_test
} // namespace fettle
