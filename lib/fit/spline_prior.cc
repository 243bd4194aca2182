#include "fit/spline_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <array>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

/// k-th derivatives (k = 0 … 3) of the four basis functions over a unit cell.
Vector4d basis_derivative(int k, double f)
{
    const double g = 1 - f;
    switch (k) {
    case 0:
        return Vector4d(g * g * g, 4 - 6 * f * f + 3 * f * f * f, 4 - 6 * g * g + 3 * g * g * g, f * f * f) / 6;
    case 1:
        return Vector4d(-g * g, 3 * f * f - 4 * f, 4 * g - 3 * g * g, f * f) / 2;
    case 2:
        return {g, 3 * f - 2, 3 * g - 2, f};
    default:
        return {-1, 3, -3, 1};
    }
}

/// ∫ B_i^(k) B_j^(k) over `cells` cells of width h. Four Gauss points are exact to degree 7; the integrand has 6.
MatrixXd gram(int k, Index cells, double h)
{
    constexpr std::array<double, 2> kNode = {0.33998104358485626, 0.86113631159405258};
    constexpr std::array<double, 2> kWeight = {0.65214515486254614, 0.34785484513745386};
    Eigen::Matrix4d cell = Eigen::Matrix4d::Zero();
    for (int i = 0; i < 2; ++i)
        for (const double side : {-1.0, 1.0}) {
            const Vector4d b = basis_derivative(k, (1 + side * kNode[i]) / 2);
            cell += kWeight[i] / 2 * b * b.transpose();
        }
    cell *= std::pow(h, 1 - 2 * k);
    MatrixXd sum = MatrixXd::Zero(cells + 3, cells + 3);
    for (Index i = 0; i < cells; ++i) sum.block<4, 4>(i, i) += cell;
    return sum;
}

/// Control heights are column-major: those of u run fastest.
MatrixXd kronecker(const MatrixXd& v, const MatrixXd& u)
{
    MatrixXd product(v.rows() * u.rows(), v.cols() * u.cols());
    for (Index i = 0; i < v.rows(); ++i)
        for (Index j = 0; j < v.cols(); ++j)
            product.block(i * u.rows(), j * u.cols(), u.rows(), u.cols()) = v(i, j) * u;
    return product;
}

/// Control values of 1, x, x² for uniform cubic knots (Marsden's identity): with the Greville abscissa g_i = (i - 1) h,
/// x has g_i and x² has g_i² - h²/3.
Eigen::MatrixX3d monomials(Index cells, double h, double middle, double scale)
{
    Eigen::MatrixX3d columns(cells + 3, 3);
    for (Index i = 0; i < cells + 3; ++i) {
        const double greville = static_cast<double>(i - 1) * h - middle;
        columns.row(i) << 1, greville / scale, (greville * greville - h * h / 3) / (scale * scale);
    }
    return columns;
}

} // namespace

MatrixXd third_derivative_energy(const Bspline& grid)
{
    constexpr std::array<double, 4> kBinomial = {1, 3, 3, 1};
    const Index rows = grid.heights.rows();
    const Index columns = grid.heights.cols();
    MatrixXd energy = MatrixXd::Zero(rows * columns, rows * columns);
    for (int k = 0; k <= 3; ++k)
        energy += kBinomial[k] * kronecker(gram(3 - k, columns - 3, grid.cell.y()), gram(k, rows - 3, grid.cell.x()));
    return energy;
}

SplinePrior spline_prior(const Bspline& grid)
{
    SplinePrior prior;
    const Eigen::Array2d cells(static_cast<double>(grid.heights.rows() - 3),
                               static_cast<double>(grid.heights.cols() - 3));
    prior.middle = cells * grid.cell.array() / 2;
    prior.half = prior.middle.maxCoeff();
    const Eigen::MatrixX3d u = monomials(grid.heights.rows() - 3, grid.cell.x(), prior.middle.x(), prior.half);
    const Eigen::MatrixX3d v = monomials(grid.heights.cols() - 3, grid.cell.y(), prior.middle.y(), prior.half);
    prior.quadratics.resize(grid.heights.size(), 6);
    const std::array<std::array<int, 2>, 6> powers = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
    for (Index k = 0; k < 6; ++k) prior.quadratics.col(k) = kronecker(v.col(powers[k][1]), u.col(powers[k][0]));

    // K⁺ = (K + s Q Qᵀ)⁻¹ - Q Qᵀ / s with Q an orthonormal basis of the quadratics, which are K's null space; s of
    // K's own size keeps the matrix well conditioned.
    const MatrixXd K = third_derivative_energy(grid);
    const Index size = K.rows();
    const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(prior.quadratics).householderQ() * MatrixXd::Identity(size, 6);
    const double s = K.trace() / static_cast<double>(size);
    prior.pseudo_inverse = (K + s * Q * Q.transpose()).llt().solve(MatrixXd::Identity(size, size));
    prior.pseudo_inverse -= Q * Q.transpose() / s;
    return prior;
}

} // namespace fettle
