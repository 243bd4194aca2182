#include "fit/spline_prior.h"

#include "core/decompositions.h"
#include "surface/spline_energy.h"

#include <Eigen/Cholesky>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

} // namespace

MatrixXd third_derivative_energy(const Bspline& grid)
{
    BandMatrix band = band_over(grid);
    add_energy(band, grid, 1);
    MatrixXd energy = MatrixXd::Zero(band.size(), band.size());
    for (Index i = 0; i < band.size(); ++i)
        for (Index j = std::max<Index>(0, i - band.half()); j <= i; ++j) energy(i, j) = energy(j, i) = band(i, j);
    return energy;
}

SplinePrior spline_prior(const Bspline& grid)
{
    const Quadratics known = quadratics(grid);
    SplinePrior prior{known.heights, known.middle, known.half, {}};
    // K⁺ = (K + s Q Qᵀ)⁻¹ - Q Qᵀ / s with Q an orthonormal basis of the quadratics, which are K's null space; s of
    // K's own size keeps the matrix well conditioned.
    const MatrixXd K = third_derivative_energy(grid);
    const Index size = K.rows();
    const MatrixXd Q = orthogonal(prior.quadratics, 6).Q;
    const double s = K.trace() / static_cast<double>(size);
    prior.pseudo_inverse = (K + s * Q * Q.transpose()).llt().solve(MatrixXd::Identity(size, size));
    prior.pseudo_inverse -= Q * Q.transpose() / s;
    return prior;
}

} // namespace fettle
