#include "surface/precision.h"

#include "core/constants.h"
#include "surface/shapes.h"
#include "surface/spline_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::surface {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBasisPerCell = 16; // bicubic basis functions that do not vanish over a cell

/// gᵀ Z g, where Z is known inside the band only: it contains all pairs of basis functions over a cell.
double variance(const BandMatrix& Z, const BsplineWeights& w, Index rows)
{
    double sum = 0;
    for (Index a = 0; a < kBasisPerCell; ++a) {
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
    BandMatrix sum = zero_band_matrix(grid);
    add_derivative_energy(sum, grid, 1 / (precision.amplitude * precision.amplitude));
    add_cell_weights(sum, grid, precision.weights);
    return sum;
}

VectorXd sigmas(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy)
{
    const BandMatrix inverse = BandCholesky(precision_matrix(spline, precision)).inverse_in_band();
    VectorXd result(xy.cols());
    tbb::parallel_for(Index{0}, xy.cols(), [&](Index i) {
        const std::optional<BsplineWeights> w = weights(spline, xy.col(i));
        result[i] = w ? std::sqrt(std::max(variance(inverse, *w, spline.heights.rows()), 0.0)) : core::kNaN;
    });
    return result;
}

MatrixXd height_covariance(const Bspline& spline, const SplinePrecision& precision, const Eigen::Matrix2Xd& xy)
{
    const BandCholesky factor(precision_matrix(spline, precision));
    MatrixXd root(spline.heights.size(), xy.cols()); // L⁻¹ G
    tbb::parallel_for(Index{0}, xy.cols(),
                      [&](Index i) { root.col(i) = factor.solve_lower(height_gradient(spline, xy.col(i))); });
    return root.transpose() * root;
}

} // namespace fettle::surface
