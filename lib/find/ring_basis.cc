#include "find/ring_basis.h"

#include "core/simd.h"
#include "geometry/quantiles.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <span>

namespace fettle::find {

using Eigen::Index;

Eigen::Vector3d Crease::terms(double x, double y) const
{
    const double beyond = std::max(0.0, across.x() * x + across.y() * y - offset);
    return {beyond, beyond * (across.x() * y - across.y() * x), beyond * beyond};
}

void monomials(double x, double y, int degree, double* row)
{
    row[0] = 1;
    Index k = 1;
    for (int total = 1; total <= degree; ++total) { // each row of Pascal's triangle from the one above it
        const Index above = k - total;
        for (int b = 0; b < total; ++b) row[k++] = row[above + b] * x;
        row[k++] = row[above + total - 1] * y;
    }
}

RingBasis::RingBasis(const Eigen::Matrix2Xd& xy, int degree) : columns_(xy.cols(), kCreaseTerms + terms_of(degree))
{
    const auto x = xy.row(0).transpose().array(), y = xy.row(1).transpose().array();
    Index k = kCreaseTerms;
    columns_.col(k++).setOnes();
    for (int total = 1; total <= degree; ++total) { // as monomials()
        const Index above = k - total;
        for (int b = 0; b < total; ++b) columns_.col(k++).array() = columns_.col(above + b).array() * x;
        columns_.col(k++).array() = columns_.col(above + total - 1).array() * y;
    }
}

void RingBasis::set_crease(const Eigen::Matrix2Xd& xy, const Crease& crease)
{
    for (Index i = 0; i < xy.cols(); ++i)
        columns_.row(i).head<kCreaseTerms>() = crease.terms(xy(0, i), xy(1, i)).transpose();
}

namespace {

using core::Double4;

FETTLE_INLINE Double4 lanes(const double* numbers) { return *reinterpret_cast<const Double4*>(numbers); }
FETTLE_INLINE double sum_of(const Double4& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

/// Products of a column with four others, which lie one after the other. Rows are a multiple of four.
FETTLE_INLINE void dot_four(const double* column, const double* others, Index rows, double* products)
{
    const double *a = others, *b = a + rows, *c = b + rows, *d = c + rows;
    Double4 sum_a{}, sum_b{}, sum_c{}, sum_d{};
    for (Index r = 0; r < rows; r += 4) {
        const Double4 value = lanes(column + r);
        sum_a += value * lanes(a + r);
        sum_b += value * lanes(b + r);
        sum_c += value * lanes(c + r);
        sum_d += value * lanes(d + r);
    }
    products[0] = sum_of(sum_a), products[1] = sum_of(sum_b), products[2] = sum_of(sum_c), products[3] = sum_of(sum_d);
}

FETTLE_INLINE double dot(const double* column, const double* other, Index rows)
{
    Double4 sum{};
    for (Index r = 0; r < rows; r += 4) sum += lanes(column + r) * lanes(other + r);
    return sum_of(sum);
}

/// The lower half of Aᵀ W A, by columns, and Aᵀ W z. Of some hundred rows and no more than 18 columns this takes a
/// third of the time of Eigen's products.
/// @param rows  a multiple of four   @param weighted  room for a column   @param G  columns x columns
FETTLE_CLONES void weighted_products(const double* A, const double* weights, const double* z, Index rows, Index columns,
                                     double* weighted, double* G, double* right)
{
    for (Index j = 0; j < columns; ++j) {
        for (Index r = 0; r < rows; r += 4)
            *reinterpret_cast<Double4*>(weighted + r) = lanes(weights + r) * lanes(A + j * rows + r);
        Index i = j;
        for (; i + 4 <= columns; i += 4) dot_four(weighted, A + i * rows, rows, G + j * columns + i);
        for (; i < columns; ++i) G[j * columns + i] = dot(weighted, A + i * rows, rows);
        right[j] = dot(weighted, z, rows);
    }
}

/// z - A c
FETTLE_CLONES void rest(const double* A, const double* z, const double* c, Index rows, Index columns, double* residuals)
{
    for (Index r = 0; r < rows; r += 4) {
        Double4 sum = lanes(z + r);
        for (Index j = 0; j < columns; ++j) sum -= core::broadcast(c[j]) * lanes(A + j * rows + r);
        *reinterpret_cast<Double4*>(residuals + r) = sum;
    }
}

/// With the ridge that makes it definite.
Eigen::LLT<RingMatrix> factors(RingMatrix matrix)
{
    matrix.diagonal().array() += kRingRidge * std::max(matrix.trace(), kRingRidge);
    return Eigen::LLT<RingMatrix>(matrix);
}

} // namespace

RingColumns::NormalEquations RingColumns::normal_equations(const Eigen::VectorXd& z,
                                                           const Eigen::VectorXd& weights) const
{
    NormalEquations equations{RingMatrix(count_, count_), RingCoefficients(count_)};
    Eigen::VectorXd weighted(rows_);
    weighted_products(data_, weights.data(), z.data(), rows_, count_, weighted.data(), equations.matrix.data(),
                      equations.right.data());
    return equations;
}

RingColumns::NormalEquations RingColumns::NormalEquations::head(Index count) const
{
    return {matrix.topLeftCorner(count, count), right.head(count)};
}

RingCoefficients RingColumns::NormalEquations::solution() const { return factors(matrix).solve(right); }

RingMatrix RingColumns::NormalEquations::inverse() const
{
    return factors(matrix).solve(RingMatrix::Identity(matrix.rows(), matrix.cols()));
}

Eigen::VectorXd RingColumns::residuals(const Eigen::VectorXd& z, const RingCoefficients& coefficients) const
{
    Eigen::VectorXd result(rows_);
    rest(data_, z.data(), coefficients.data(), rows_, count_, result.data());
    return result;
}

double ChosenSizes::quantile(double share) { return geometry::quantile(std::span(sizes_.data(), count_), share); }

double ChosenSizes::median() { return geometry::median(std::span(sizes_.data(), count_)); }

double quantile_of_sizes(const Eigen::VectorXd& residuals, double share)
{
    ChosenSizes sizes(residuals.size());
    for (const double residual : residuals) sizes.add(residual, true);
    return sizes.quantile(share);
}

Ring thinned(const Ring& ring, Index max_count)
{
    const Index all = ring.z.size(), count = count_in_lanes(std::min(all, max_count));
    Ring some{Eigen::Matrix2Xd(2, count), Eigen::VectorXd(count), Eigen::VectorXd(count), ring.sigma, ring.independent};
    for (Index k = 0; k < count; ++k) {
        const Index i = k * all / count;
        some.xy.col(k) = ring.xy.col(i);
        some.z[k] = ring.z[i];
        some.near[k] = ring.near[i];
    }
    return some;
}

void reweigh(Eigen::VectorXd& weights, const Eigen::VectorXd& residuals, const Eigen::VectorXd& chosen,
             double min_spread)
{
    ChosenSizes sizes(residuals.size());
    for (Index i = 0; i < residuals.size(); ++i) sizes.add(residuals[i], chosen[i] > 0);
    const double spread = std::max(geometry::kMedianToSigma * sizes.median(), min_spread);
    weights.array() /= (residuals.array().abs() / spread).max(1);
}

} // namespace fettle::find
