#include "fit/cell_moments.h"

#include "core/simd.h"
#include "surface/spline_energy.h"

#include <array>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The sums of a cell are stored in rows of powers of u: seven rows of eight for the matrix (v^0 … v^6; the eighth
// number of the first row is Σ w r²), then as_double4 rows of as_double4 for the right-hand side.
constexpr Index kRowStride = 8;
constexpr Index kPowers = 7;
constexpr Index kRhsOffset = kPowers * kRowStride;
constexpr Index kSumsPerCell = kRhsOffset + 16;

/// Entry (i, a) is the coefficient of tᵃ in the i-th basis function of a cell, t from the cell's middle.
Matrix4d basis_coefficients()
{
    Matrix4d b;
    b << 1, -6, 12, -8,   //
        23, -30, -12, 24, //
        23, 30, -12, -24, //
        1, 6, 12, 8;
    return b / 48;
}

/// Entry (pair, a) is the coefficient of tᵃ in the product of basis functions i and j, i <= j, pairs row by row.
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

/// Index of the pair (i, j), in either order.
constexpr std::array<std::array<int, 4>, 4> kPairIndex = {{{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}}};

core::Double4& as_double4(double* at) { return *reinterpret_cast<core::Double4*>(at); }
const core::Double4& as_double4(const double* at) { return *reinterpret_cast<const core::Double4*>(at); }

FETTLE_CLONES void add_points(double* sums, const CellPoint* points, const double* r, const double* w,
                              std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double u = points[i].u, v = points[i].v;
        const double u2 = u * u, u4 = u2 * u2;
        const core::Double4 low = {1, u, u2, u * u2};
        const core::Double4 high = {u4, u4 * u, u4 * u2, r[i] * r[i]};
        double* cell = sums + points[i].cell * kSumsPerCell;
        double scale = w[i];
        for (Index b = 0; b < kPowers; ++b, scale *= v) {
            const core::Double4 scaled = low * scale;
            as_double4(cell + b * kRowStride) += scaled;
            as_double4(cell + b * kRowStride + 4) += high * scale;
            if (b < 4) as_double4(cell + kRhsOffset + 4 * b) += scaled * r[i];
        }
    }
}

FETTLE_CLONES void subtract_polynomials(const CellPoint* points, const double* polynomials, double* r,
                                        std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double* c = polynomials + 16 * points[i].cell;
        const double u = points[i].u, v = points[i].v;
        const core::Double4 of_u =
            as_double4(c) + v * (as_double4(c + 4) + v * (as_double4(c + 8) + v * as_double4(c + 12)));
        r[i] = points[i].z - (of_u[0] + u * (of_u[1] + u * (of_u[2] + u * of_u[3])));
    }
}

} // namespace

std::vector<double> cell_polynomials(const surface::Bspline& spline)
{
    const Matrix4d b = basis_coefficients();
    const Index cells_u = spline.heights.rows() - 3, cells_v = spline.heights.cols() - 3;
    std::vector<double> polynomials(16 * cells_u * cells_v);
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

CellMoments::CellMoments(const surface::Bspline& grid)
    : cells_u_(grid.heights.rows() - 3), cells_v_(grid.heights.cols() - 3), sums_(kSumsPerCell * cells_u_ * cells_v_)
{
}

void CellMoments::add(std::span<const CellPoint> points, const double* r, const double* w)
{
    add_points(sums_.data(), points.data(), r, w, points.size());
}

void CellMoments::add(const CellMoments& other)
{
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
}

MatrixXd CellMoments::weights() const
{
    using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    return Eigen::Map<const MatrixXd, 0, Stride>(sums_.data(), cells_u_, cells_v_,
                                                 Stride(kSumsPerCell * cells_u_, kSumsPerCell));
}

MatrixXd CellMoments::mean_residuals() const
{
    MatrixXd means(cells_u_, cells_v_);
    for (Index k = 0; k < means.size(); ++k) {
        const double* cell = sums_.data() + kSumsPerCell * k;
        means.data()[k] = cell[0] > 0 ? cell[kRhsOffset] / cell[0] : 0;
    }
    return means;
}

surface::BandMatrix CellMoments::normal_matrix(const surface::Bspline& grid, const MatrixXd& s) const
{
    using Moments = Eigen::Matrix<double, kPowers, kPowers>; // (power of u, power of v)
    const Eigen::Matrix<double, 10, kPowers> products = product_coefficients();
    surface::BandMatrix sum = surface::zero_band_matrix(grid);
    const Index rows = grid.heights.rows();
    for (Index column = 0; column < cells_v_; ++column)
        for (Index row = 0; row < cells_u_; ++row) {
            const double* cell = sums_.data() + kSumsPerCell * (column * cells_u_ + row);
            if (cell[0] == 0) continue;
            const Eigen::Map<const Moments, 0, Eigen::OuterStride<>> moments(cell, Eigen::OuterStride<>(kRowStride));
            const Eigen::Matrix<double, 10, 10> pairs = s(row, column) * products * moments * products.transpose();
            for (Index a = 0; a < 16; ++a)
                for (Index b = 0; b <= a; ++b)
                    sum((column + a / 4) * rows + row + a % 4, (column + b / 4) * rows + row + b % 4) +=
                        pairs(kPairIndex[a % 4][b % 4], kPairIndex[a / 4][b / 4]);
        }
    return sum;
}

VectorXd CellMoments::right_side(const MatrixXd& s) const
{
    const Matrix4d b = basis_coefficients();
    MatrixXd sum = MatrixXd::Zero(cells_u_ + 3, cells_v_ + 3);
    for (Index column = 0; column < cells_v_; ++column)
        for (Index row = 0; row < cells_u_; ++row)
            sum.block<4, 4>(row, column) +=
                s(row, column) * b *
                Eigen::Map<const Matrix4d>(sums_.data() + kSumsPerCell * (column * cells_u_ + row) + kRhsOffset) *
                b.transpose();
    return sum.reshaped();
}

double CellMoments::square_sum(const MatrixXd& s) const
{
    double sum = 0;
    for (Index cell = 0; cell < s.size(); ++cell) sum += s.data()[cell] * sums_[kSumsPerCell * cell + kRowStride - 1];
    return sum;
}

} // namespace fettle::fit
