#include "surface/precision.h"

#include "surface/shapes.h"
#include "surface/spline_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kWeights = 16; // basis functions over a cell

/// gᵀ Z g with Z known inside the band, where all pairs of functions over a cell are.
double variance(const BandMatrix& Z, const BsplineWeights& w, Index rows)
{
    double sum = 0;
    for (Index a = 0; a < kWeights; ++a) {
        const Index i = (w.column + a / 4) * rows + w.row + a % 4;
        const double g = w.u[a % 4] * w.v[a / 4];
        for (Index b = 0; b < a; ++b)
            sum += 2 * g * w.u[b % 4] * w.v[b / 4] * Z(i, (w.column + b / 4) * rows + w.row + b % 4);
        sum += g * g * Z(i, i);
    }
    return sum;
}

} // namespace

BandMatrix precision_matrix(const Bspline& grid, const SplinePrecision& precision)
{
    BandMatrix sum = band_over(grid);
    add_energy(sum, grid, 1 / (precision.amplitude * precision.amplitude));
    add_uniform(sum, grid, precision.weights);
    return sum;
}

VectorXd sigmas(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy)
{
    const BandMatrix inverse = BandCholesky(precision_matrix(spline, precision)).inverse_in_band();
    VectorXd result(xy.cols());
    tbb::parallel_for(Index{0}, xy.cols(), [&](Index i) {
        const std::optional<BsplineWeights> w = weights(spline, xy.col(i));
        result[i] = w ? std::sqrt(std::max(variance(inverse, *w, spline.heights.rows()), 0.0))
                      : std::numeric_limits<double>::quiet_NaN();
    });
    return result;
}

MatrixXd height_covariance(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy)
{
    const BandCholesky factor(precision_matrix(spline, precision));
    MatrixXd half(spline.heights.size(), xy.cols()); // L⁻¹ G
    tbb::parallel_for(Index{0}, xy.cols(),
                      [&](Index i) { half.col(i) = factor.half_solve(height_gradient(spline, xy.col(i))); });
    return half.transpose() * half;
}

} // namespace fettle
