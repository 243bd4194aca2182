#include "surface/spline_energy.h"

#include "surface/basis.h"

#include <array>
#include <cmath>

namespace fettle::surface {

namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector4d;

constexpr Index kBasisOverlap = 3; // a cubic basis function overlaps that many others on either side

/// ∫ B_i^(k) B_j^(k) over a unit cell. Four Gauss points are exact to degree 7; the integrand has 6.
Matrix4d cell_gram(int k)
{
    constexpr std::array<double, 2> kNode = {0.33998104358485626, 0.86113631159405258};
    constexpr std::array<double, 2> kWeight = {0.65214515486254614, 0.34785484513745386};
    Matrix4d cell = Matrix4d::Zero();
    for (int i = 0; i < 2; ++i)
        for (const double side : {-1.0, 1.0}) {
            const Vector4d b = uniform_cubic_basis((1 + side * kNode[i]) / 2, k);
            cell += kWeight[i] / 2 * b * b.transpose();
        }
    return cell;
}

/// ∫ B_i^(k) B_j^(k) over `cells` cells of width h.
MatrixXd gram(int k, Index cells, double h)
{
    const Matrix4d cell = cell_gram(k) * std::pow(h, 1 - 2 * k);
    MatrixXd sum = MatrixXd::Zero(cells + 3, cells + 3);
    for (Index i = 0; i < cells; ++i) sum.block<4, 4>(i, i) += cell;
    return sum;
}

/// Control values of 1, x, x² for uniform cubic knots (Marsden's identity): with the Greville abscissa g_i = (i - 1) h,
/// x has g_i and x² has g_i² - h²/3.
Eigen::MatrixX3d monomial_controls(Index cells, double h, double middle, double scale)
{
    Eigen::MatrixX3d columns(cells + 3, 3);
    for (Index i = 0; i < cells + 3; ++i) {
        const double greville = (i - 1) * h - middle;
        columns.row(i) << 1, greville / scale, (greville * greville - h * h / 3) / (scale * scale);
    }
    return columns;
}

} // namespace

BandMatrix zero_band_matrix(const Bspline& grid)
{
    return {grid.heights.size(), kBasisOverlap * grid.heights.rows() + kBasisOverlap};
}

void add_derivative_energy(BandMatrix& sum, const Bspline& grid, double factor)
{
    constexpr std::array<double, 4> kBinomial = {1, 3, 3, 1};
    const Index rows = grid.heights.rows(), columns = grid.heights.cols();
    for (int k = 0; k <= 3; ++k) {
        const MatrixXd u = gram(k, rows - 3, grid.cell.x());
        const MatrixXd v = gram(3 - k, columns - 3, grid.cell.y());
        for (Index j = 0; j < columns; ++j)
            for (Index l = std::max<Index>(0, j - kBasisOverlap); l <= j; ++l)
                for (Index i = 0; i < rows; ++i) {
                    double* row = sum.row(j * rows + i) + l * rows;
                    const Index last = l == j ? i : std::min(rows - 1, i + kBasisOverlap);
                    for (Index m = std::max<Index>(0, i - kBasisOverlap); m <= last; ++m)
                        row[m] += factor * kBinomial[k] * v(j, l) * u(i, m);
                }
    }
}

void add_cell_weights(BandMatrix& sum, const Bspline& grid, const MatrixXd& weights)
{
    const Index rows = grid.heights.rows();
    const Matrix4d mean = cell_gram(0);
    for (Index column = 0; column < weights.cols(); ++column)
        for (Index row = 0; row < weights.rows(); ++row) {
            if (weights(row, column) == 0) continue;
            for (Index a = 0; a < 16; ++a)
                for (Index b = 0; b <= a; ++b)
                    sum((column + a / 4) * rows + row + a % 4, (column + b / 4) * rows + row + b % 4) +=
                        weights(row, column) * mean(a / 4, b / 4) * mean(a % 4, b % 4);
        }
}

QuadraticControlHeights quadratic_control_heights(const Bspline& grid)
{
    QuadraticControlHeights result;
    const Index rows = grid.heights.rows(), columns = grid.heights.cols();
    const Eigen::Array2d cells(rows - 3, columns - 3);
    result.middle = cells * grid.cell.array() / 2;
    result.half_side = result.middle.maxCoeff();
    const Eigen::MatrixX3d u = monomial_controls(rows - 3, grid.cell.x(), result.middle.x(), result.half_side);
    const Eigen::MatrixX3d v = monomial_controls(columns - 3, grid.cell.y(), result.middle.y(), result.half_side);
    const std::array<std::array<int, 2>, 6> powers = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
    result.heights.resize(rows * columns, 6);
    for (Index k = 0; k < 6; ++k)
        result.heights.col(k) = (u.col(powers[k][0]) * v.col(powers[k][1]).transpose()).reshaped();
    return result;
}

} // namespace fettle::surface
