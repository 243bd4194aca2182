#include "fit/cell_moments.h"

#include "core/simd.h"
#include "surface/spline_energy.h"

#include <array>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of a cell, in rows of powers of u: seven rows of eight for the matrix (v^0 … v^6; the eighth number of the first is
// Σ w r²), then four rows of four for the right side.
constexpr Index kRow = 8;
constexpr Index kPowers = 7;
constexpr Index kRight = kPowers * kRow;
constexpr Index kSums = kRight + 16;

/// (i, a): coefficient of tᵃ in the i-th basis function of a cell, t from the cell's middle.
Matrix4d basis_coefficients()
{
    Matrix4d b;
    b << 1, -6, 12, -8,   //
        23, -30, -12, 24, //
        23, 30, -12, -24, //
        1, 6, 12, 8;
    return b / 48;
}

/// (pair, a): of tᵃ in the product of the i-th and the j-th, i <= j, pairs row by row.
Eigen::Matrix<double, 10, kPowers> product_coefficients()
{
    const Matrix4d b = basis_coefficients();
    Eigen::Matrix<double, 10, kPowers> products = Eigen::Matrix<double, 10, kPowers>::Zero();
    for (int i = 0, pair = 0; i < 4; ++i)
        for (int j = i; j < 4; ++j, ++pair)
            for (int a = 0; a < 4; ++a)
                for (int c = 0; c < 4; ++c) products(pair, a + c) += b(i, a) * b(j, c);
    return products;
}

/// Number of the pair (i, j), in either order.
constexpr std::array<std::array<int, 4>, 4> kPair = {{{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}}};

Double4& four(double* at) { return *reinterpret_cast<Double4*>(at); }
const Double4& four(const double* at) { return *reinterpret_cast<const Double4*>(at); }

FETTLE_CLONES void add_points(double* sums, const CellPoint* points, const double* r, const double* w,
                              std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double u = points[i].u, v = points[i].v;
        const double u2 = u * u, u4 = u2 * u2;
        const Double4 low = {1, u, u2, u * u2};
        const Double4 high = {u4, u4 * u, u4 * u2, r[i] * r[i]};
        double* cell = sums + points[i].cell * kSums;
        double scale = w[i];
        for (Index b = 0; b < kPowers; ++b, scale *= v) {
            const Double4 scaled = low * scale;
            four(cell + b * kRow) += scaled;
            four(cell + b * kRow + 4) += high * scale;
            if (b < 4) four(cell + kRight + 4 * b) += scaled * r[i];
        }
    }
}

FETTLE_CLONES void subtract_polynomials(const CellPoint* points, const double* polynomials, double* r,
                                        std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double* c = polynomials + 16 * points[i].cell;
        const double u = points[i].u, v = points[i].v;
        const Double4 of_u = four(c) + v * (four(c + 4) + v * (four(c + 8) + v * four(c + 12)));
        r[i] = points[i].z - (of_u[0] + u * (of_u[1] + u * (of_u[2] + u * of_u[3])));
    }
}

FETTLE_CLONES void add_all(double* to, const double* from, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) to[i] += from[i];
}

} // namespace

std::vector<double> cell_polynomials(const Bspline& spline)
{
    const Matrix4d b = basis_coefficients();
    const Index cells_u = spline.heights.rows() - 3, cells_v = spline.heights.cols() - 3;
    std::vector<double> polynomials(static_cast<std::size_t>(16 * cells_u * cells_v));
    for (Index column = 0; column < cells_v; ++column)
        for (Index row = 0; row < cells_u; ++row)
            Eigen::Map<Matrix4d>(polynomials.data() + 16 * (column * cells_u + row)) =
                b.transpose() * spline.heights.block<4, 4>(row, column) * b;
    return polynomials;
}

void residuals(std::span<const CellPoint> points, const std::vector<double>& polynomials, double* r)
{
    subtract_polynomials(points.data(), polynomials.data(), r, points.size());
}

CellMoments::CellMoments(const Bspline& grid)
    : cells_u_(grid.heights.rows() - 3), cells_v_(grid.heights.cols() - 3),
      sums_(static_cast<std::size_t>(kSums * cells_u_ * cells_v_))
{
}

void CellMoments::add(std::span<const CellPoint> points, const double* r, const double* w)
{
    add_points(sums_.data(), points.data(), r, w, points.size());
}

void CellMoments::add(const CellMoments& other) { add_all(sums_.data(), other.sums_.data(), sums_.size()); }

MatrixXd CellMoments::weights() const
{
    using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    return Eigen::Map<const MatrixXd, 0, Stride>(sums_.data(), cells_u_, cells_v_, Stride(kSums * cells_u_, kSums));
}

BandMatrix CellMoments::matrix(const Bspline& grid, const MatrixXd& s) const
{
    using Moments = Eigen::Matrix<double, kPowers, kPowers>; // (power of u, power of v)
    const Eigen::Matrix<double, 10, kPowers> products = product_coefficients();
    BandMatrix sum = band_over(grid);
    const Index rows = grid.heights.rows();
    for (Index column = 0; column < cells_v_; ++column)
        for (Index row = 0; row < cells_u_; ++row) {
            const double* cell = sums_.data() + kSums * (column * cells_u_ + row);
            if (cell[0] == 0) continue;
            const Eigen::Map<const Moments, 0, Eigen::OuterStride<>> moments(cell, Eigen::OuterStride<>(kRow));
            const Eigen::Matrix<double, 10, 10> pairs = s(row, column) * products * moments * products.transpose();
            for (Index a = 0; a < 16; ++a)
                for (Index b = 0; b <= a; ++b)
                    sum((column + a / 4) * rows + row + a % 4, (column + b / 4) * rows + row + b % 4) +=
                        pairs(kPair[a % 4][b % 4], kPair[a / 4][b / 4]);
        }
    return sum;
}

VectorXd CellMoments::right(const MatrixXd& s) const
{
    const Matrix4d b = basis_coefficients();
    MatrixXd sum = MatrixXd::Zero(cells_u_ + 3, cells_v_ + 3);
    for (Index column = 0; column < cells_v_; ++column)
        for (Index row = 0; row < cells_u_; ++row)
            sum.block<4, 4>(row, column) +=
                s(row, column) * b *
                Eigen::Map<const Matrix4d>(sums_.data() + kSums * (column * cells_u_ + row) + kRight) * b.transpose();
    return sum.reshaped();
}

double CellMoments::square(const MatrixXd& s) const
{
    double sum = 0;
    for (Index cell = 0; cell < s.size(); ++cell)
        sum += s.data()[cell] * sums_[static_cast<std::size_t>(kSums * cell + kRow - 1)];
    return sum;
}

} // namespace fettle
