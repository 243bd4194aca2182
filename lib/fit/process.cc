#include "fit/process.h"

#include "surface/shapes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ℓ over half the touched size: shorter waves than the first are beyond the spacing of any touches, longer ones than
// the last are a trend.
constexpr std::array<double, 7> kLengths = {0.25, 0.35, 0.5, 0.7, 1, 1.4, 2};
// τ over σ: from what the touches cannot see to a thousand times what they resolve, half a unit of ln apart.
constexpr double kLeastRatio = 0.3;
constexpr int kRatios = 21;
constexpr double kRatioStep = 1.6487212707001282;

/// One trend and length, as independent numbers: y_i ~ N(0, σ² + τ² λ_i).
struct Spectrum {
    std::size_t trend = 0;
    double length = 0;  ///< mm
    VectorXd lambda, y; ///< y over σ
};

/// A hypothesis that has weight.
struct Hypothesis {
    std::size_t trend = 0;
    double length = 0; ///< mm
    double tau = 0;    ///< mm
    double score = 0;
};

MatrixXd correlation(const Matrix2Xd& a, const Matrix2Xd& b, double length)
{
    MatrixXd K(a.cols(), b.cols());
    for (Index j = 0; j < b.cols(); ++j)
        K.col(j) = ((a.colwise() - b.col(j)).colwise().squaredNorm().array() / (-2 * length * length)).exp();
    return K;
}

/// Half the touched size, however it is turned.
double half_size(const Matrix2Xd& xy)
{
    return (xy.colwise() - xy.rowwise().mean().eval()).colwise().norm().maxCoeff();
}

/// Touches, and what is known of each trend there.
struct Problem {
    Matrix2Xd xy;
    double sigma = 0;
    std::vector<const Candidate*> trends;
    std::vector<MatrixXd> F;        ///< n x p, orthonormal columns that span the trend's changes
    std::vector<VectorXd> residual; ///< touch - trend, mm
};

Problem part_of(const Problem& all, const Columns& kept)
{
    Problem part{all.xy(Eigen::all, kept), all.sigma, all.trends, {}, {}};
    for (std::size_t k = 0; k < all.trends.size(); ++k) {
        part.F.push_back(all.F[k](kept, Eigen::all));
        part.residual.push_back(all.residual[k](kept));
    }
    return part;
}

Spectrum spectrum(const Problem& problem, std::size_t trend, double length, const MatrixXd& rest)
{
    const MatrixXd K = rest.transpose() * correlation(problem.xy, problem.xy, length) * rest;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(K);
    return {trend, length, eigen.eigenvalues().cwiseMax(0),
            eigen.eigenvectors().transpose() * (rest.transpose() * problem.residual[trend]) / problem.sigma};
}

/// All trends, lengths and amplitudes. Scores as the families': -2 ln restricted likelihood + p ln n, from that of σ.
std::vector<Hypothesis> hypotheses(const Problem& problem)
{
    std::vector<Hypothesis> all;
    const double half = half_size(problem.xy);
    const auto n = problem.xy.cols();
    for (std::size_t k = 0; k < problem.trends.size(); ++k) {
        const Index p = problem.F[k].cols();
        const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(problem.F[k]).householderQ() * MatrixXd::Identity(n, n);
        const MatrixXd rest = Q.rightCols(n - p);
        for (const double length : kLengths) {
            const Spectrum s = spectrum(problem, k, length * half, rest);
            double ratio = kLeastRatio;
            for (int i = 0; i < kRatios; ++i, ratio *= kRatioStep) {
                const Eigen::ArrayXd variance = 1 + ratio * ratio * s.lambda.array();
                const double score = variance.log().sum() + (s.y.array().square() / variance).sum() +
                                     static_cast<double>(p) * std::log(static_cast<double>(n));
                all.push_back({k, s.length, ratio * problem.sigma, score});
            }
        }
    }
    return all;
}

const Hypothesis& best_of(const std::vector<Hypothesis>& all)
{
    return *std::min_element(all.begin(), all.end(),
                             [](const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; });
}

/// What one hypothesis says given the touches; C = σ² + τ² K.
struct Given {
    Eigen::LLT<MatrixXd> C;
    MatrixXd CF;              ///< C⁻¹ F
    Eigen::LLT<MatrixXd> FCF; ///< Fᵀ C⁻¹ F
    VectorXd beta;            ///< of the trend's changes
    VectorXd alpha;           ///< C⁻¹ (r - F β)
};

Given given(const Problem& problem, const Hypothesis& h)
{
    Given g;
    MatrixXd C = h.tau * h.tau * correlation(problem.xy, problem.xy, h.length);
    C.diagonal().array() += problem.sigma * problem.sigma;
    g.C.compute(C);
    g.CF = g.C.solve(problem.F[h.trend]);
    g.FCF.compute(problem.F[h.trend].transpose() * g.CF);
    g.beta = g.FCF.solve(g.CF.transpose() * problem.residual[h.trend]);
    g.alpha = g.C.solve(problem.residual[h.trend] - problem.F[h.trend] * g.beta);
    return g;
}

/// The touch that is better explained as a slip than by the others, most of all (leave-one-out: Wahba 1990, 4.2); -1.
Index worst_slip(const Problem& problem)
{
    const Hypothesis h = best_of(hypotheses(problem));
    const Given g = given(problem, h);
    const Index n = problem.xy.cols();
    const MatrixXd P = g.C.solve(MatrixXd::Identity(n, n)) - g.CF * g.FCF.solve(g.CF.transpose());
    Index worst = -1;
    double most = 0;
    for (Index i = 0; i < n; ++i) {
        const double precision = P(i, i) * problem.sigma * problem.sigma;
        const double gain = g.alpha[i] * g.alpha[i] / P(i, i) - std::log(precision) - price_of_a_slip(problem.sigma);
        if (gain > most) {
            most = gain;
            worst = i;
        }
    }
    return worst;
}

// --- onto the grid ---------------------------------------------------------------------------------------------------

/// Control values of a uniform cubic B-spline from function values at the Greville abscissae and one beyond each end:
/// c_i = (-f_{i-1} + 8 f_i - f_{i+1}) / 6 is exact for cubics (quasi-interpolant: de Boor 2001, XII).
MatrixXd quasi_interpolant(Index controls)
{
    MatrixXd A = MatrixXd::Zero(controls, controls + 2);
    for (Index i = 0; i < controls; ++i) A.row(i).segment<3>(i) << -1.0 / 6, 8.0 / 6, -1.0 / 6;
    return A;
}

Matrix2Xd nodes_of(const Bspline& grid)
{
    const Index rows = grid.heights.rows() + 2, columns = grid.heights.cols() + 2;
    Matrix2Xd xy(2, rows * columns);
    Eigen::Matrix2d turn;
    turn << std::cos(grid.angle), -std::sin(grid.angle), std::sin(grid.angle), std::cos(grid.angle);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i)
            xy.col(j * rows + i) =
                grid.origin +
                turn *
                    (Eigen::Vector2d(static_cast<double>(i - 2), static_cast<double>(j - 2)).cwiseProduct(grid.cell));
    return xy;
}

/// Mean and covariance at the nodes.
struct Field {
    VectorXd mean;
    MatrixXd covariance;
};

Field field_of(const Problem& problem, const Hypothesis& h, const Matrix2Xd& nodes, const VectorXd& trend,
               const MatrixXd& F_nodes)
{
    const Given g = given(problem, h);
    const double t2 = h.tau * h.tau;
    const MatrixXd K = t2 * correlation(nodes, problem.xy, h.length); // N x n
    Field field;
    field.mean = trend + F_nodes * g.beta + K * g.alpha;
    const MatrixXd half = g.C.matrixL().solve(K.transpose());
    const MatrixXd D = F_nodes - K * g.CF;
    const MatrixXd half_D = g.FCF.matrixL().solve(D.transpose());
    field.covariance = t2 * correlation(nodes, nodes, h.length);
    field.covariance.noalias() -= half.transpose() * half;
    field.covariance.noalias() += half_D.transpose() * half_D;
    return field;
}

} // namespace

std::optional<Candidate> fit_process(const Touched& touched, const std::vector<Candidate>& trends, const Bspline& grid)
{
    const Matrix2Xd nodes = nodes_of(grid);
    Problem all{touched.xyz.topRows(2), touched.sigma, {}, {}, {}};
    std::vector<VectorXd> trend_nodes;
    std::vector<MatrixXd> F_nodes;
    for (const Candidate& trend : trends) {
        if (trend.covariance.rows() >= touched.xyz.cols()) continue;
        const VectorXd z = heights(trend.shape, nodes);
        const MatrixXd G = height_gradients(trend.shape, nodes), touches = height_gradients(trend.shape, all.xy);
        if (!z.allFinite() || !G.allFinite() || !touches.allFinite()) continue;
        // Orthonormal columns: Gᵀ = F R.
        const Eigen::HouseholderQR<MatrixXd> qr(touches.transpose());
        const Index p = touches.rows();
        all.trends.push_back(&trend);
        all.F.push_back(qr.householderQ() * MatrixXd::Identity(touches.cols(), p));
        all.residual.push_back(touched.xyz.row(2).transpose() - heights(trend.shape, all.xy));
        trend_nodes.push_back(z);
        const MatrixXd R = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
        F_nodes.push_back(R.transpose().triangularView<Eigen::Lower>().solve(G).transpose());
    }
    if (all.trends.empty()) return std::nullopt;

    Columns kept = all_touches(touched);
    Problem problem = all;
    Index parameters = 0;
    for (const MatrixXd& F : all.F) parameters = std::max(parameters, F.cols());
    constexpr Index kRest = 2; // touches that nothing has taken up yet
    const auto most_slips =
        static_cast<std::size_t>(std::clamp(touched.xyz.cols() - parameters - kRest, Index{0}, touched.xyz.cols() / 4));
    Candidate candidate;
    candidate.method = "gp";
    while (candidate.gross_errors.size() < most_slips) {
        const Index worst = worst_slip(problem);
        if (worst < 0) break;
        candidate.gross_errors.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        problem = part_of(all, kept);
    }
    std::sort(candidate.gross_errors.begin(), candidate.gross_errors.end());

    // Their mean by probability.
    constexpr double kLeastWeight = 0.01; // of the most probable one
    const std::vector<Hypothesis> believed = hypotheses(problem);
    const double best = best_of(believed).score;
    double sum = 0, used = 0;
    VectorXd mean = VectorXd::Zero(nodes.cols());
    std::vector<std::pair<double, Field>> fields;
    for (const Hypothesis& h : believed) {
        const double weight = std::exp((best - h.score) / 2);
        sum += weight;
        if (weight < kLeastWeight) continue;
        fields.emplace_back(weight, field_of(problem, h, nodes, trend_nodes[h.trend], F_nodes[h.trend]));
        mean += weight * fields.back().second.mean;
        used += weight;
    }
    mean /= used;
    MatrixXd covariance = MatrixXd::Zero(nodes.cols(), nodes.cols());
    for (const auto& [weight, field] : fields) {
        const VectorXd off = field.mean - mean;
        covariance += weight / used * field.covariance;
        covariance.noalias() += weight / used * off * off.transpose();
    }

    Bspline spline = grid;
    const MatrixXd U = quasi_interpolant(grid.heights.rows()), V = quasi_interpolant(grid.heights.cols());
    MatrixXd A(grid.heights.size(), nodes.cols());
    for (Index i = 0; i < V.rows(); ++i)
        for (Index j = 0; j < V.cols(); ++j) A.block(i * U.rows(), j * U.cols(), U.rows(), U.cols()) = V(i, j) * U;
    spline.heights = (A * mean).reshaped(grid.heights.rows(), grid.heights.cols());
    candidate.covariance = A * covariance * A.transpose();
    candidate.shape = std::move(spline);
    candidate.score = best - 2 * std::log(sum / static_cast<double>(believed.size())) +
                      price_of_a_slip(touched.sigma) * static_cast<double>(candidate.gross_errors.size());
    candidate.freedom = static_cast<double>(kept.size()) - static_cast<double>(all.F.front().cols());
    return candidate;
}

} // namespace fettle
