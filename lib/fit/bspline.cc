#include "fit/bspline.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "fit/dense.h"
#include "fit/evidence.h"
#include "fit/robust_linear.h"
#include "fit/round_part.h"
#include "fit/spline_prior.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLeastTouches = 6;
// Touches in F4 are rounded by 6e-8 of their size; a spread across a line below that is not there.
constexpr double kRounding = 1e-6;

void refuse_line(const FitInput& input, const Eigen::Matrix3Xd& touches)
{
    const Eigen::Matrix2Xd d = touches.topRows(2).colwise() - touches.topRows(2).rowwise().mean().eval();
    const SymmetricEigen<2> spread = symmetric_eigen<2>(d * d.transpose());
    const double least = std::sqrt(std::max(spread.values[0], 0.0) / static_cast<double>(d.cols()));
    const double most = std::sqrt(spread.values[1] / static_cast<double>(d.cols()));
    if (least <= std::max(input.job.probe.accuracy, kRounding * most))
        throw InputError(input.source, "touches lie on one line in x and y");
}

std::shared_ptr<const Cloud> cloud_of(const FitInput& input)
{
    auto cloud = std::make_shared<Cloud>();
    cloud->xyz = input.xyz;
    set_field(*cloud, "role", input.roles.cast<double>());
    return cloud;
}

constexpr Index kQuadratics = 6;         // 1, u, v, u², uv, v²
constexpr Index kBeta = kQuadratics + 1; // and the round part's share

// Castings are turned, swept and blended: a curved surface is expected to be round (share 1 of the round part; a
// paraboloid, share 0, is no rarity), and to differ from that by about as much as a round surface differs from a
// quadratic. Both spreads are so that sigma is right over sheared spheres, waves, tori, panels (Bspline.SigmaCovers… in
// the tests) and the 95 % shift safe over paraboloids (Posterior.is_safe…): smaller ones over-grind one or the other.
constexpr double kRoundnessSpread = 0.6;
constexpr double kRoughness = 0.7;

/// Everything at the touches: z = level + the expected round part + H β + g. β's prior is N(0, 1 / precision²).
struct Model {
    SplinePrior prior;
    MatrixXd basis;     ///< N x kBeta, control heights of β's columns
    VectorXd expected;  ///< N, control heights of the round part
    MatrixXd A;         ///< n x N, touches from control heights
    MatrixXd GA;        ///< K⁺ Aᵀ
    MatrixXd H;         ///< n x kBeta, the columns at the touches
    MatrixXd R;         ///< A K⁺ Aᵀ
    VectorXd precision; ///< of β: 1 / standard deviation; 0 for 1, u, v
    VectorXd z;         ///< touches less the expected, mm
    double level = 0;   ///< mm
    double least_tau = 0;
};

/// Size of the second derivatives of u², uv and v² (Frobenius norm of D²; uv's stands there twice), 1/mm.
Eigen::Vector3d second_derivatives(double half) { return Eigen::Vector3d(2, std::sqrt(2.0), 2) / (half * half); }

double touched_size(const Eigen::Matrix3Xd& touches)
{
    return (touches.topRows(2).rowwise().maxCoeff() - touches.topRows(2).rowwise().minCoeff()).norm();
}

/// The quadratic that, with its round part, is nearest to the touches; first of all without it.
struct Osculating {
    Eigen::Matrix<double, 6, 1> quadratic;
    VectorXd round; ///< control heights
};

Osculating osculating(const Model& m, const Bspline& grid, const VectorXd& z)
{
    constexpr int kIterations = 50; // the round part changes the curvature by a few percent: a digit each time
    const MatrixXd quadratics = m.A * m.prior.quadratics;
    const auto solve = [&](const VectorXd& heights) { // a twist that is only rounding is left 0
        return shortest_least_squares(quadratics, heights, kRounding).x;
    };
    const Eigen::Matrix2Xd uv = quadratics.middleCols(1, 2).transpose();
    Osculating result{solve(z), VectorXd::Zero(m.A.cols())};
    for (int i = 0; i < kIterations; ++i) {
        result.round = round_part(grid, m.prior, result.quadratic, uv);
        const Eigen::Matrix<double, 6, 1> next = solve(z - m.A * result.round);
        const bool settled = (next - result.quadratic).norm() <= kRounding * next.norm();
        result.quadratic = next;
        if (settled) break;
    }
    return result;
}

/// √E of a sphere with that curvature. With
/// z = … - κ³ r⁴/8 its energy density is 12 κ⁶ r². Steeper than a sphere may be (κ r = 1 at the outermost touch), the
/// series says nothing.
double round_amplitude(const SplinePrior& prior, double curvature, double size)
{
    const double kappa = std::min(curvature / std::sqrt(2.0), 2 / size); // |D²| of a sphere is √2 κ
    const double mean_r2 = prior.middle.squaredNorm() / 3;               // over the rectangle
    const double area = 4 * prior.middle.prod();
    return std::sqrt(12 * mean_r2 * area) * kappa * kappa * kappa;
}

Model model_of(const Bspline& grid, const Surface& surface)
{
    Model m;
    m.prior = spline_prior(grid);
    m.A = height_gradients(grid, surface.touches.topRows(2)).transpose();
    m.GA.noalias() = m.prior.pseudo_inverse * m.A.transpose();
    m.R.noalias() = m.A * m.GA;
    m.level = surface.touches.row(2).mean();
    const VectorXd z = surface.touches.row(2).transpose().array() - m.level;
    const Osculating shape = osculating(m, grid, z);
    m.expected = shape.round;
    m.z = z - m.A * m.expected;
    m.basis.resize(m.A.cols(), kBeta);
    m.basis << m.prior.quadratics, shape.round;
    m.H.noalias() = m.A * m.basis;

    // No less than what changes the slope by 1 over the touched length.
    const double size = touched_size(surface.touches);
    const Eigen::Vector3d second = second_derivatives(m.prior.half);
    const double touched = shape.quadratic.tail(3).cwiseProduct(second).norm();
    m.precision.setZero(kBeta);
    m.precision.segment(3, 3) = second / std::max(touched, 1 / size);
    m.precision[kQuadratics] = 1 / kRoundnessSpread;
    m.least_tau = kRoughness * round_amplitude(m.prior, touched, size);
    return m;
}

Amplitude amplitude_of(const Model& m, double sigma, Index spare)
{
    constexpr Index kFree = 3; // 1, u, v
    const MatrixXd H = m.H.rightCols(kBeta - kFree);
    const VectorXd variance = m.precision.tail(kBeta - kFree).cwiseAbs2().cwiseInverse();
    const FieldModel field{m.H.leftCols(kFree), H * variance.asDiagonal() * H.transpose(), m.R, sigma, m.least_tau};
    return amplitude(field, m.z, spare);
}

constexpr Index kSpare = 6; // the three curvatures of a quadratic, and three touches more

/// Posterior covariance of the control heights, and of the touched heights (for the degrees of freedom).
struct Posterior {
    MatrixXd covariance;
    double freedom = 0;
};

/// Universal kriging (Cressie 1993, 3.4) with noise σ²/w_i: no matrix that is the worse for a small τ.
Posterior posterior(const Model& m, double sigma, double tau, const VectorXd& weight)
{
    const double t2 = tau * tau;
    MatrixXd M = t2 * m.R;
    M.diagonal() += sigma * sigma * weight.cwiseInverse();
    const Eigen::LLT<MatrixXd> noise(M);
    const MatrixXd half_H = noise.matrixL().solve(m.H);
    MatrixXd precision = half_H.transpose() * half_H;
    precision.diagonal() += m.precision.cwiseAbs2();
    const Eigen::LLT<MatrixXd> beta(precision);

    const MatrixXd half_GA = noise.matrixL().solve(t2 * m.GA.transpose()); // n x N
    const MatrixXd leverage = m.basis - half_GA.transpose() * half_H;      // N x kBeta
    const MatrixXd half = beta.matrixL().solve(leverage.transpose());
    Posterior result;
    result.covariance = t2 * m.prior.pseudo_inverse;
    result.covariance.noalias() -= half_GA.transpose() * half_GA;
    result.covariance.noalias() += half.transpose() * half;

    // Variance of the fitted height over that of the touch: the share of each touch that went into parameters.
    const VectorXd fitted = (m.A * result.covariance).cwiseProduct(m.A).rowwise().sum();
    result.freedom = static_cast<double>(m.A.rows()) - fitted.cwiseProduct(weight).sum() / (sigma * sigma);
    return result;
}

} // namespace

/// Cells are about square, two for each touch along the longer side: finer ones change the surface by less than the
/// probe sees. One cell all around keeps the wheel's footprint on the grid.
Bspline spline_grid(const FitInput& input, const Eigen::Matrix3Xd& touches)
{
    Eigen::Matrix2Xd xy(2, touches.cols() + input.job.anomaly.cols());
    xy << touches.topRows(2), input.job.anomaly.topRows(2);
    xy = rotation_working_machine(input.job.theta) * xy;
    const Eigen::Vector2d least = xy.rowwise().minCoeff();
    const Eigen::Vector2d side = xy.rowwise().maxCoeff() - least;
    const double touches_a_side = std::sqrt(static_cast<double>(touches.cols()));
    const double cells = std::clamp(std::ceil(2 * touches_a_side), 6.0, 12.0);
    const double cell = side.maxCoeff() / cells;
    const Eigen::Vector2d counts = (side / cell).array().round().max(2);
    Bspline grid;
    grid.angle = input.job.theta;
    grid.cell = side.cwiseQuotient(counts);
    grid.origin = rotation_working_machine(input.job.theta).transpose() * (least - grid.cell);
    constexpr Index kAround = 2 + 3; // a cell on both sides, and the cubic's three more functions than cells
    grid.heights.setZero(static_cast<Index>(counts.x()) + kAround, static_cast<Index>(counts.y()) + kAround);
    return grid;
}

double field_amplitude(const FitInput& input, double sigma)
{
    const Surface surface = begin_surface(input, "bspline", kSampleRoles, kLeastTouches);
    return amplitude_of(model_of(spline_grid(input, surface.touches), surface), sigma, surface.touches.cols()).rms;
}

Fit fit_bspline(const FitInput& input)
{
    if (input.xyz.cols() > static_cast<Index>(kMostExactTouches))
        return fit_dense(point_source(cloud_of(input)), input.job, input.use_boundary, input.source).fit;
    Surface surface = begin_surface(input, "bspline", kSampleRoles, kLeastTouches);
    refuse_line(input, surface.touches);
    Bspline spline = spline_grid(input, surface.touches);
    const Model m = model_of(spline, surface);
    const double sigma = surface.touch_sigma;
    const Amplitude believed = amplitude_of(m, sigma, kSpare);
    const double tau = believed.rms;

    // R = S Sᵀ; touches on the same place make it singular: only what is above rounding.
    const SymmetricEigen<Eigen::Dynamic> eigen = symmetric_eigen(m.R);
    constexpr double kRank = 1e-12;
    const VectorXd& d = eigen.values;
    const Index rank = (d.array() > kRank * d.maxCoeff()).count();
    const VectorXd root = d.tail(rank).cwiseSqrt();
    const MatrixXd V = eigen.vectors.rightCols(rank);

    // Unknown: β, and γ in units of its prior's τ.
    RobustLinear problem;
    problem.A.resize(m.z.size(), kBeta + rank);
    problem.A << m.H, V * (tau * root).asDiagonal();
    problem.A /= sigma;
    problem.b = m.z / sigma;
    problem.A(believed.gross_errors, Eigen::all).setZero();
    problem.b(believed.gross_errors).setZero();
    problem.width = input.job.probe.accuracy / sigma;
    problem.prior.setOnes(kBeta + rank);
    problem.prior.head(kBeta) = m.precision;
    RobustLinearResult solved = solve(problem);
    constexpr double kNoWeight = 1e-9; // a slip's touch error is 30000 times a touch's, so it says nothing
    solved.weight(believed.gross_errors).setConstant(kNoWeight);

    const VectorXd controls =
        m.expected + m.basis * solved.x.head(kBeta) + m.GA * (V * (tau * solved.x.tail(rank)).cwiseQuotient(root));
    spline.heights = controls.reshaped(spline.heights.rows(), spline.heights.cols()).array() + m.level;
    surface.shape = spline;
    surface.gross_errors = believed.gross_errors;
    std::sort(surface.gross_errors.begin(), surface.gross_errors.end());
    const Posterior belief = posterior(m, sigma, tau, solved.weight);
    surface.covariance = belief.covariance;
    return finish_fit(std::move(surface), belief.freedom, solved.converged, solved.iterations);
}

} // namespace fettle
