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
// the last are polynomials to the probe.
constexpr std::array<double, 9> kLengths = {0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8, 4};
// τ over σ: from what the touches cannot see to what bends as much as they do over the longest of them, half a unit of
// ln apart.
constexpr double kLeastRatio = 0.3;
constexpr int kRatios = 25;
constexpr double kRatioStep = 1.6487212707001282;

/// Smooth without end (squared exponential), or twice differentiable (Matérn's of 5/2), which trusts waves less to go
/// on beneath the anomaly as they do between the touches.
enum class Roughness { none, matern };

struct Correlation {
    Roughness roughness = Roughness::none;
    double length = 0; ///< mm
};

/// One correlation, as independent numbers: y_i ~ N(0, σ² + τ² λ_i).
struct Spectrum {
    VectorXd lambda, y; ///< y over σ
};

struct Hypothesis {
    Correlation correlation;
    double tau = 0; ///< mm
    double score = 0;
};

MatrixXd correlations(const Correlation& correlation, const Matrix2Xd& a, const Matrix2Xd& b)
{
    const double length = correlation.length;
    MatrixXd K(a.cols(), b.cols());
    for (Index j = 0; j < b.cols(); ++j) {
        const Eigen::ArrayXd squared = (a.colwise() - b.col(j)).colwise().squaredNorm().array() / (length * length);
        if (correlation.roughness == Roughness::none) {
            K.col(j) = (squared / -2).exp();
        } else {
            const Eigen::ArrayXd r = (5 * squared).sqrt();
            K.col(j) = (1 + r + r.square() / 3) * (-r).exp();
        }
    }
    return K;
}

/// Half the touched size, however it is turned.
double half_size(const Matrix2Xd& xy)
{
    return (xy.colwise() - xy.rowwise().mean().eval()).colwise().norm().maxCoeff();
}

/// Touches z = F β + g + e.
struct Problem {
    Matrix2Xd xy;
    VectorXd z;
    double sigma = 0;
    MatrixXd F; ///< n x p, of the trend
};

Problem part_of(const Problem& all, const Columns& kept)
{
    return {all.xy(Eigen::all, kept), all.z(kept), all.sigma, all.F(kept, Eigen::all)};
}

Spectrum spectrum(const Problem& problem, const Correlation& correlation, const MatrixXd& rest)
{
    const MatrixXd K = rest.transpose() * correlations(correlation, problem.xy, problem.xy) * rest;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(K);
    return {eigen.eigenvalues().cwiseMax(0),
            eigen.eigenvectors().transpose() * (rest.transpose() * problem.z) / problem.sigma};
}

/// All correlations and amplitudes. Scores as the families': -2 ln restricted likelihood + p ln n, from that of σ.
std::vector<Hypothesis> hypotheses(const Problem& problem)
{
    std::vector<Hypothesis> all;
    const double half = half_size(problem.xy);
    const Index n = problem.F.rows(), p = problem.F.cols();
    const double price = static_cast<double>(p) * std::log(static_cast<double>(n));
    const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(problem.F).householderQ() * MatrixXd::Identity(n, n);
    const MatrixXd rest = Q.rightCols(n - p);
    for (const Roughness roughness : {Roughness::none, Roughness::matern})
        for (const double length : kLengths) {
            const Correlation correlation{roughness, length * half};
            const Spectrum s = spectrum(problem, correlation, rest);
            double ratio = kLeastRatio;
            for (int i = 0; i < kRatios; ++i, ratio *= kRatioStep) {
                const Eigen::ArrayXd variance = 1 + ratio * ratio * s.lambda.array();
                const double score = variance.log().sum() + (s.y.array().square() / variance).sum() + price;
                all.push_back({correlation, ratio * problem.sigma, score});
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
    VectorXd beta;            ///< of the trend
    VectorXd alpha;           ///< C⁻¹ (z - F β)
};

Given given(const Problem& problem, const Hypothesis& h)
{
    Given g;
    MatrixXd C = h.tau * h.tau * correlations(h.correlation, problem.xy, problem.xy);
    C.diagonal().array() += problem.sigma * problem.sigma;
    g.C.compute(C);
    g.CF = g.C.solve(problem.F);
    g.FCF.compute(problem.F.transpose() * g.CF);
    g.beta = g.FCF.solve(g.CF.transpose() * problem.z);
    g.alpha = g.C.solve(problem.z - problem.F * g.beta);
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

Field field_of(const Problem& problem, const Hypothesis& h, const Matrix2Xd& nodes, const MatrixXd& F_nodes)
{
    const Given g = given(problem, h);
    const double t2 = h.tau * h.tau;
    const MatrixXd K = t2 * correlations(h.correlation, nodes, problem.xy); // N x n
    Field field;
    field.mean = F_nodes * g.beta + K * g.alpha;
    const MatrixXd half = g.C.matrixL().solve(K.transpose());
    const MatrixXd D = F_nodes - K * g.CF;
    const MatrixXd half_D = g.FCF.matrixL().solve(D.transpose());
    field.covariance = t2 * correlations(h.correlation, nodes, nodes);
    field.covariance.noalias() -= half.transpose() * half;
    field.covariance.noalias() += half_D.transpose() * half_D;
    return field;
}

} // namespace

std::optional<Candidate> fit_process(const Touched& touched, const Bspline& grid)
{
    std::optional<FamilySolution> trend = solve_family("quadratic", touched, all_touches(touched));
    if (!trend) trend = solve_family("plane", touched, all_touches(touched));
    constexpr Index kRest = 2; // touches that nothing has taken up yet
    if (!trend || touched.xyz.cols() < trend->gradients.rows() + kRest) return std::nullopt;
    const Problem all{touched.xyz.topRows(2), touched.xyz.row(2).transpose(), touched.sigma,
                      trend->gradients.transpose()};
    const Matrix2Xd nodes = nodes_of(grid);
    const MatrixXd F_nodes = height_gradients(trend->shape, nodes).transpose();

    Columns kept = all_touches(touched);
    Problem problem = all;
    const auto most_slips =
        static_cast<std::size_t>(std::min(touched.xyz.cols() - all.F.cols() - kRest, touched.xyz.cols() / 4));
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
        fields.emplace_back(weight, field_of(problem, h, nodes, F_nodes));
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
    candidate.freedom = static_cast<double>(kept.size()) - static_cast<double>(all.F.cols());
    return candidate;
}

} // namespace fettle
