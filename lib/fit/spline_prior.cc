#include "fit/spline_prior.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "fit/smoothing.h"
#include "surface/spline_energy.h"

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd dense_energy_matrix(const surface::Bspline& grid)
{
    const surface::BandMatrix band = spline_energy_matrix(grid).K;
    MatrixXd K = MatrixXd::Zero(band.size(), band.size());
    for (Index i = 0; i < band.size(); ++i)
        for (Index j = std::max<Index>(0, i - band.half_bandwidth()); j <= i; ++j) K(i, j) = K(j, i) = band(i, j);
    return K;
}

} // namespace

SplinePrior spline_prior(const surface::Bspline& grid)
{
    const surface::QuadraticControlHeights known = surface::quadratic_control_heights(grid);
    SplinePrior prior{known.heights, known.middle, known.half_side, {}};
    // K⁺ = (K + s Q Qᵀ)⁻¹ - Q Qᵀ / s with Q an orthonormal basis of the quadratics, which are K's null space. The mean
    // eigenvalue of K as s keeps the matrix well conditioned.
    const MatrixXd K = dense_energy_matrix(grid);
    const MatrixXd Q = core::householder_qr(prior.quadratics, 6).Q;
    const double s = K.trace() / K.rows();
    prior.pseudo_inverse = core::Cholesky(K + s * Q * Q.transpose()).solve(MatrixXd::Identity(K.rows(), K.rows()));
    prior.pseudo_inverse -= Q * Q.transpose() / s;
    return prior;
}

} // namespace fettle::fit
