#include "fit/round_part.h"

#include "core/decompositions.h"

#include <algorithm>
#include <cmath>

namespace fettle::fit {

namespace {

// A principal curvature below this share of the other one counts as zero (a cylinder's axis): the slope along it is a
// tilt, which has no apex.
constexpr double kFlatCurvatureRatio = 0.1;

/// The quadratic in its principal directions; lengths in mm.
struct PrincipalForm {
    Eigen::Vector2d gradient; ///< at the rectangle's centre
    Eigen::Matrix2d hessian;
    Eigen::Vector2d curvature; ///< principal
    Eigen::Matrix2d directions;
    double flat_curvature = 0; ///< curvature that counts as zero, 1/mm

    /// Q and |∇Q|² of the curved directions at the offset d from the centre: Q = Σ p²/2λ with p the gradient along a
    /// principal direction of curvature λ.
    Eigen::Vector2d operator()(const Eigen::Vector2d& d) const
    {
        const Eigen::Vector2d p = directions.transpose() * (gradient + hessian * d);
        Eigen::Vector2d result = Eigen::Vector2d::Zero();
        for (int i = 0; i < 2; ++i) {
            const double ratio = curvature[i] / flat_curvature;
            const double curved = 1 / (1 + std::pow(ratio, -4)); // 1 - 1e-4 for the greater curvature
            if (curved == 0) continue;
            result[0] += curved * p[i] * p[i] / curvature[i] / 2;
            result[1] += curved * p[i] * p[i];
        }
        return result;
    }
};

PrincipalForm principal_form(const Eigen::Matrix<double, 6, 1>& q, double half)
{
    PrincipalForm form;
    form.gradient = q.segment<2>(1) / half;
    form.hessian << 2 * q[3], q[4], q[4], 2 * q[5];
    form.hessian /= half * half;
    const core::SymmetricEigen<2> principal = core::symmetric_eigen(form.hessian);
    form.curvature = principal.values;
    form.directions = principal.vectors;
    form.flat_curvature = kFlatCurvatureRatio * form.curvature.cwiseAbs().maxCoeff();
    return form;
}

/// Round surface minus quadratic. Beyond the slope limit it grows in proportion to Q.
double round_difference(const Eigen::Vector2d& Q_slope2)
{
    const double slope2 = std::min(Q_slope2[1], kMaxRoundSlope * kMaxRoundSlope);
    return Q_slope2[0] * (2 / (1 + std::sqrt(1 - slope2)) - 1);
}

} // namespace

Eigen::VectorXd round_part(const surface::Bspline& grid, const SplinePrior& prior,
                           const Eigen::Matrix<double, 6, 1>& quadratic, const Eigen::Matrix2Xd& uv)
{
    const PrincipalForm form = principal_form(quadratic, prior.half);
    if (form.flat_curvature == 0) return Eigen::VectorXd::Zero(grid.heights.size());
    for (Eigen::Index i = 0; i < uv.cols(); ++i)
        if (form(prior.half * uv.col(i))[1] > kMaxRoundSlope * kMaxRoundSlope)
            return Eigen::VectorXd::Zero(grid.heights.size());

    // The local quasi-interpolant that reproduces cubics: c_i = (-f_{i-1} + 8 f_i - f_{i+1}) / 6 at the Greville
    // abscissae (de Boor 1978, ch. XII), in both directions.
    const Eigen::Index rows = grid.heights.rows();
    const Eigen::Index columns = grid.heights.cols();
    Eigen::MatrixXd f(rows + 2, columns + 2);
    for (Eigen::Index j = 0; j < columns + 2; ++j)
        for (Eigen::Index i = 0; i < rows + 2; ++i) {
            const Eigen::Array2d index(i - 2, j - 2);
            f(i, j) = round_difference(form((index * grid.cell.array()).matrix() - prior.middle));
        }
    const Eigen::MatrixXd g = (8 * f.middleRows(1, rows) - f.topRows(rows) - f.bottomRows(rows)) / 6;
    const Eigen::MatrixXd c = (8 * g.middleCols(1, columns) - g.leftCols(columns) - g.rightCols(columns)) / 6;
    return c.reshaped();
}

} // namespace fettle::fit
