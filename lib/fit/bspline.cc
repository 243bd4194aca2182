#include "fit/bspline.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "fit/dense.h"
#include "fit/evidence.h"
#include "fit/robust_linear.h"
#include "fit/round_part.h"
#include "fit/spline_prior.h"
#include "geometry/bounding_box.h"
#include "surface/shapes.h"

#include <algorithm>
#include <cmath>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMinTouches = 6;
// Single-precision files round coordinates by 6e-8 of their size, so smaller relative spreads are roundoff.
constexpr double kRoundingTolerance = 1e-6;

std::shared_ptr<const cloud::Cloud> to_cloud(const FitInput& input)
{
    auto cloud = std::make_shared<cloud::Cloud>();
    cloud->xyz = input.xyz;
    cloud::set_field(*cloud, "role", input.roles.cast<double>());
    return cloud;
}

constexpr Index kNumQuadratics = 6;            // 1, u, v, u², uv, v²
constexpr Index kNumBeta = kNumQuadratics + 1; // and the coefficient of the round part

// Castings are turned, swept and blended, so a curved surface is expected to be round: the coefficient of the round
// part has the prior mean 1 (paraboloids, coefficient 0, are common too), and the remainder is about as large as the
// difference between a round surface and a quadratic. With these two prior scales sigma is right over sheared spheres,
// waves, tori and panels (Bspline.SigmaCovers… in the tests: of 2,000 draws of each, at most 1.2 % beyond the 99 %
// quantile) and the 95 % shift is safe over paraboloids (Posterior.is_safe…). A wider coefficient over-grinds steep
// spheres: with 0.6 and 0.7, 3.2 % of them lay beyond.
constexpr double kRoundCoefficientSigma = 0.4;
constexpr double kRemainderPerRoundAmplitude = 0.58;

/// The linear model of the touches: z = level + the expected round part + H β + g. β's prior is N(0, 1 / precision²).
struct Model {
    SplinePrior prior;
    MatrixXd basis;     ///< N x kNumBeta, control heights of β's columns
    VectorXd expected;  ///< N, control heights of the round part
    MatrixXd A;         ///< n x N, touches from control heights
    MatrixXd GA;        ///< K⁺ Aᵀ
    MatrixXd H;         ///< n x kNumBeta, β's columns at the touches
    MatrixXd R;         ///< A K⁺ Aᵀ
    VectorXd precision; ///< 1 / prior standard deviation of β; 0 for 1, u, v
    VectorXd z;         ///< touches minus level and round part, mm
    double level = 0;   ///< mm
    double min_tau = 0; ///< lower scale of τ expected before touching, 1/mm
};

/// Frobenius norms of D² of u², uv and v² (uv's mixed derivative counts twice), 1/mm.
Eigen::Vector3d second_derivatives(double half) { return Eigen::Vector3d(2, std::sqrt(2.0), 2) / (half * half); }

double bounding_diagonal(const Eigen::Matrix3Xd& touches)
{
    return geometry::bounding_box(touches.topRows<2>()).sizes().norm();
}

/// A quadratic with its round part.
struct RoundedQuadratic {
    Eigen::Matrix<double, 6, 1> quadratic;
    VectorXd round; ///< control heights
};

/// Least squares by fixed-point iteration: the round part follows from the quadratic, which is fitted to the rest.
RoundedQuadratic fit_rounded_quadratic(const Model& m, const surface::Bspline& grid, const VectorXd& z)
{
    constexpr int kMaxIterations = 50; // the round part changes the curvature by a few percent: a digit each time
    const MatrixXd quadratics = m.A * m.prior.quadratics;
    const auto solve = [&](const VectorXd& heights) { // a twist that is only rounding stays 0
        return core::min_norm_least_squares(quadratics, heights, kRoundingTolerance).x;
    };
    const Eigen::Matrix2Xd uv = quadratics.middleCols(1, 2).transpose();
    RoundedQuadratic result{solve(z), VectorXd::Zero(m.A.cols())};
    for (int i = 0; i < kMaxIterations; ++i) {
        result.round = round_part(grid, m.prior, result.quadratic, uv);
        const Eigen::Matrix<double, 6, 1> next = solve(z - m.A * result.round);
        const bool converged = (next - result.quadratic).norm() <= kRoundingTolerance * next.norm();
        result.quadratic = next;
        if (converged) break;
    }
    return result;
}

/// √E of a sphere with that curvature. Its height is z = … - κ³ r⁴/8, so the energy density is 12 κ⁶ r². The series
/// does not hold beyond κ r = 1 at the outermost touch, where the sphere is vertical; κ is limited to that.
double sphere_amplitude(const SplinePrior& prior, double curvature, double size)
{
    const double kappa = std::min(curvature / std::sqrt(2.0), 2 / size); // |D²| of a sphere is √2 κ
    const double mean_r2 = prior.middle.squaredNorm() / 3;               // over the rectangle
    const double area = 4 * prior.middle.prod();
    return std::sqrt(12 * mean_r2 * area) * kappa * kappa * kappa;
}

Model build_model(const surface::Bspline& grid, const surface::Surface& surface)
{
    Model m;
    m.prior = spline_prior(grid);
    m.A = surface::height_gradients(grid, surface.touches.topRows(2)).transpose();
    m.GA.noalias() = m.prior.pseudo_inverse * m.A.transpose();
    m.R.noalias() = m.A * m.GA;
    m.level = surface.touches.row(2).mean();
    const VectorXd z = surface.touches.row(2).transpose().array() - m.level;
    const RoundedQuadratic shape = fit_rounded_quadratic(m, grid, z);
    m.expected = shape.round;
    m.z = z - m.A * m.expected;
    m.basis.resize(m.A.cols(), kNumBeta);
    m.basis << m.prior.quadratics, shape.round;
    m.H.noalias() = m.A * m.basis;

    // The curvature's prior scale is at least that of slopes that change by 1 over the touched length.
    const double size = bounding_diagonal(surface.touches);
    const Eigen::Vector3d second = second_derivatives(m.prior.half);
    const double curvature = shape.quadratic.tail(3).cwiseProduct(second).norm();
    m.precision.setZero(kNumBeta);
    m.precision.segment(3, 3) = second / std::max(curvature, 1 / size);
    m.precision[kNumQuadratics] = 1 / kRoundCoefficientSigma;
    m.min_tau = kRemainderPerRoundAmplitude * sphere_amplitude(m.prior, curvature, size);
    return m;
}

Amplitude estimate_tau(const Model& m, double sigma, Index min_redundancy)
{
    constexpr Index kNumFixed = 3; // 1, u, v
    const MatrixXd H = m.H.rightCols(kNumBeta - kNumFixed);
    const VectorXd variance = m.precision.tail(kNumBeta - kNumFixed).cwiseAbs2().cwiseInverse();
    const FieldModel field{m.H.leftCols(kNumFixed), H * variance.asDiagonal() * H.transpose(), m.R, sigma, m.min_tau};
    return estimate_amplitude(field, m.z, min_redundancy);
}

struct Posterior {
    MatrixXd covariance; ///< of the control heights
    double freedom = 0;  ///< degrees of freedom of the residuals
};

/// Universal kriging (Cressie 1993, 3.4) with noise σ²/w_i: no matrix is ill-conditioned for a small τ.
Posterior compute_posterior(const Model& m, double sigma, double tau, const VectorXd& weight)
{
    const double t2 = tau * tau;
    MatrixXd M = t2 * m.R;
    M.diagonal() += sigma * sigma * weight.cwiseInverse();
    const core::Cholesky noise(M);
    const MatrixXd half_H = noise.solve_lower(m.H);
    MatrixXd precision = half_H.transpose() * half_H;
    precision.diagonal() += m.precision.cwiseAbs2();
    const core::Cholesky beta(precision);

    const MatrixXd half_GA = noise.solve_lower(t2 * m.GA.transpose()); // n x N
    const MatrixXd leverage = m.basis - half_GA.transpose() * half_H;  // N x kNumBeta
    const MatrixXd half = beta.solve_lower(leverage.transpose());
    Posterior result;
    result.covariance = t2 * m.prior.pseudo_inverse;
    result.covariance.noalias() -= half_GA.transpose() * half_GA;
    result.covariance.noalias() += half.transpose() * half;

    // The leverage of a touch is the variance of its fitted height over its own.
    const VectorXd fitted = (m.A * result.covariance).cwiseProduct(m.A).rowwise().sum();
    result.freedom = m.A.rows() - fitted.cwiseProduct(weight).sum() / (sigma * sigma);
    return result;
}

} // namespace

surface::Bspline make_spline_grid(const Eigen::AlignedBox2d& box, double cells, double border, double angle)
{
    const Eigen::Vector2d side = box.sizes();
    const double cell = side.maxCoeff() / cells;
    const Eigen::Vector2d counts = (side / cell).array().round().max(2);
    surface::Bspline grid;
    grid.angle = angle;
    grid.cell = side.cwiseQuotient(counts);
    grid.origin = job::rotation_working_machine(angle).transpose() * (box.min() - border * grid.cell);
    // A cubic spline has three more basis functions than cells along each side.
    const Eigen::Array2i functions = (counts.array() + 2 * border).cast<int>() + 3;
    grid.heights.setZero(functions.x(), functions.y());
    return grid;
}

Eigen::Array2d cell_counts(const surface::Bspline& grid)
{
    return Eigen::Array2d(grid.heights.rows() - 3, grid.heights.cols() - 3);
}

surface::Bspline with_cell_counts(const surface::Bspline& grid, const Eigen::Array2d& counts)
{
    surface::Bspline result{grid.angle, grid.origin, grid.cell.array() * cell_counts(grid) / counts, {}};
    result.heights.setZero(static_cast<Index>(counts.x()) + 3, static_cast<Index>(counts.y()) + 3);
    return result;
}

surface::Bspline spline_grid(const FitInput& input, const Eigen::Matrix3Xd& touches)
{
    Eigen::Matrix2Xd xy(2, touches.cols() + input.job.anomaly.cols());
    xy << touches.topRows(2), input.job.anomaly.topRows(2);
    xy = job::rotation_working_machine(input.job.theta) * xy;
    // Two cells for each touch along the longer side: finer ones change the surface by less than the probe resolves.
    const double cells = std::clamp(std::ceil(2 * std::sqrt(touches.cols())), 6.0, 12.0);
    // One cell around everything keeps the wheel's footprint on the grid.
    return make_spline_grid(geometry::bounding_box(xy), cells, 1, input.job.theta);
}

double estimate_field_amplitude(const FitInput& input, double sigma)
{
    const surface::Surface surface = begin_surface(input, "bspline", kSampleRoles, kMinTouches);
    return estimate_tau(build_model(spline_grid(input, surface.touches), surface), sigma, surface.touches.cols()).rms;
}

Fit fit_bspline(const FitInput& input)
{
    if (input.xyz.cols() > static_cast<Index>(kMaxExactTouches))
        return fit_dense(cloud::make_point_source(to_cloud(input)), input.job, {input.use_boundary}, input.source).fit;
    surface::Surface surface = begin_surface(input, "bspline", kSampleRoles, kMinTouches);
    surface::Bspline spline = spline_grid(input, surface.touches);
    const Model m = build_model(spline, surface);
    const double sigma = surface.touch_sigma;
    constexpr Index kMinRedundancy = 6; // the three curvatures of a quadratic, and three touches more
    const Amplitude amplitude = estimate_tau(m, sigma, kMinRedundancy);
    const double tau = amplitude.rms;

    // R = S Sᵀ, S restricted to R's numerical rank: coincident touches make R singular.
    const core::SymmetricEigen<Eigen::Dynamic> eigen = core::symmetric_eigen(m.R);
    constexpr double kRankTolerance = 1e-12; // of the largest eigenvalue
    const VectorXd& d = eigen.values;
    const Index rank = (d.array() > kRankTolerance * d.maxCoeff()).count();
    const VectorXd root = d.tail(rank).cwiseSqrt();
    const MatrixXd V = eigen.vectors.rightCols(rank);

    // The unknowns are β, and γ in units of its prior's τ.
    RobustLinear problem;
    problem.A.resize(m.z.size(), kNumBeta + rank);
    problem.A << m.H, V * (tau * root).asDiagonal();
    problem.A /= sigma;
    problem.b = m.z / sigma;
    problem.A(amplitude.outliers, Eigen::all).setZero();
    problem.b(amplitude.outliers).setZero();
    problem.width = input.job.probe.accuracy / sigma;
    problem.prior.setOnes(kNumBeta + rank);
    problem.prior.head(kNumBeta) = m.precision;
    RobustLinearResult solved = solve_robust(problem);
    constexpr double kOutlierWeight = 1e-9; // > 0 to invert it: 30000 times a touch's standard deviation
    solved.weight(amplitude.outliers).setConstant(kOutlierWeight);

    const VectorXd controls =
        m.expected + m.basis * solved.x.head(kNumBeta) + m.GA * (V * (tau * solved.x.tail(rank)).cwiseQuotient(root));
    spline.heights = controls.reshaped(spline.heights.rows(), spline.heights.cols()).array() + m.level;
    surface.shape = spline;
    surface.outliers = amplitude.outliers;
    std::sort(surface.outliers.begin(), surface.outliers.end());
    const Posterior posterior = compute_posterior(m, sigma, tau, solved.weight);
    surface.covariance = posterior.covariance;
    return finish_fit(std::move(surface), posterior.freedom, solved.converged, solved.iterations);
}

} // namespace fettle::fit
