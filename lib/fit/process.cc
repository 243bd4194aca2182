#include "fit/process.h"

#include "surface/shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::Vector2d;
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

/// One correlation, as independent numbers: with E the directions in which the trend cannot move the touches, y = Eᵀ z
/// / σ, y_i ~ N(0, 1 + (τ/σ)² λ_i).
struct Spectrum {
    Correlation correlation;
    MatrixXd E; ///< n x (n - p)
    VectorXd lambda, y;
    std::array<double, kRatios> score; ///< for each τ, as the families': -2 ln restricted likelihood + p ln n
};

/// For each unit of σ².
VectorXd precision(const Spectrum& s, double ratio) { return (1 + ratio * ratio * s.lambda.array()).inverse(); }

/// At distances whose squares are given, mm².
Eigen::ArrayXd at(const Correlation& correlation, const Eigen::ArrayXd& squares)
{
    const Eigen::ArrayXd squared = squares / (correlation.length * correlation.length);
    if (correlation.roughness == Roughness::none) return (squared / -2).exp();
    const Eigen::ArrayXd r = (5 * squared).sqrt();
    return (1 + r + r.square() / 3) * (-r).exp();
}

MatrixXd correlations(const Correlation& correlation, const Matrix2Xd& a, const Matrix2Xd& b)
{
    MatrixXd K(a.cols(), b.cols());
    for (Index j = 0; j < b.cols(); ++j)
        K.col(j) = at(correlation, (a.colwise() - b.col(j)).colwise().squaredNorm().transpose());
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

double ratio_of(int i) { return kLeastRatio * std::pow(kRatioStep, i); }

/// All correlations and amplitudes: one decomposition a correlation.
std::vector<Spectrum> spectra(const Problem& problem)
{
    std::vector<Spectrum> all;
    const double half = half_size(problem.xy);
    const Index n = problem.F.rows(), p = problem.F.cols();
    const double price = static_cast<double>(p) * std::log(static_cast<double>(n));
    const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(problem.F).householderQ() * MatrixXd::Identity(n, n);
    const MatrixXd rest = Q.rightCols(n - p);
    for (const Roughness roughness : {Roughness::none, Roughness::matern})
        for (const double length : kLengths) {
            Spectrum s;
            s.correlation = {roughness, length * half};
            const MatrixXd K = correlations(s.correlation, problem.xy, problem.xy);
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(rest.transpose() * K * rest);
            s.E = rest * eigen.eigenvectors();
            s.lambda = eigen.eigenvalues().cwiseMax(0);
            s.y = s.E.transpose() * problem.z / problem.sigma;
            for (int i = 0; i < kRatios; ++i) {
                const Eigen::ArrayXd d = precision(s, ratio_of(i));
                s.score[static_cast<std::size_t>(i)] = price - d.log().sum() + (s.y.array().square() * d).sum();
            }
            all.push_back(std::move(s));
        }
    return all;
}

double best_score(const std::vector<Spectrum>& all)
{
    double best = std::numeric_limits<double>::infinity();
    for (const Spectrum& s : all) best = std::min(best, *std::min_element(s.score.begin(), s.score.end()));
    return best;
}

/// The touch that is better explained as a slip than by the others, most of all (leave-one-out: Wahba 1990, 4.2); -1.
/// With P = E (σ² + τ² λ)⁻¹ Eᵀ, touch i is off what the others say by (P z)_i / P_ii, of variance 1 / P_ii.
Index worst_slip(const std::vector<Spectrum>& all, double sigma)
{
    const double best = best_score(all);
    for (const Spectrum& s : all)
        for (int i = 0; i < kRatios; ++i) {
            if (s.score[static_cast<std::size_t>(i)] != best) continue;
            const VectorXd d = precision(s, ratio_of(i));
            const Eigen::ArrayXd P = (s.E.cwiseAbs2() * d).array(), Pz = (s.E * d.cwiseProduct(s.y)).array();
            Index worst = -1;
            const double gain = (Pz.square() / P - P.log()).maxCoeff(&worst);
            return gain > price_of_a_slip(sigma) ? worst : -1;
        }
    return -1;
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

/// Functions on the grid's nodes, by their control heights.
class Controls {
  public:
    explicit Controls(const Bspline& grid)
        : grid_(grid), U_(quasi_interpolant(grid.heights.rows())), V_(quasi_interpolant(grid.heights.cols())),
          nodes_(2, U_.cols() * V_.cols())
    {
        const Eigen::Rotation2Dd turn(grid.angle);
        for (Index j = 0; j < V_.cols(); ++j)
            for (Index i = 0; i < U_.cols(); ++i)
                nodes_.col(j * U_.cols() + i) =
                    grid.origin +
                    turn * grid.cell.cwiseProduct(Vector2d(static_cast<double>(i - 2), static_cast<double>(j - 2)));
    }

    Index size() const { return grid_.heights.size(); }
    const Matrix2Xd& nodes() const { return nodes_; }

    /// Of functions whose values at the nodes are given, one a column.
    MatrixXd from(const MatrixXd& values) const
    {
        MatrixXd result(size(), values.cols());
        for (Index k = 0; k < values.cols(); ++k)
            result.col(k) = (U_ * values.col(k).reshaped(U_.cols(), V_.cols()) * V_.transpose()).reshaped();
        return result;
    }

    /// Adds factor times the correlation of all with all to the lower half of `sum`. It depends on how many rows and
    /// columns lie between two: Σ w_p w_q (correlation of nodes p rows and q columns farther), w the interpolant's
    /// weights folded with themselves.
    void add_correlation(MatrixXd& sum, const Correlation& correlation, double factor) const
    {
        constexpr std::array<double, 5> kFolded = {1 / 36.0, -16 / 36.0, 66 / 36.0, -16 / 36.0, 1 / 36.0};
        const Index rows = grid_.heights.rows(), columns = grid_.heights.cols();
        const Eigen::ArrayXd u = Eigen::ArrayXd::LinSpaced(rows + 2, 0, static_cast<double>(rows + 1)) * grid_.cell.x();
        MatrixXd near(rows + 2, columns + 2), between = MatrixXd::Zero(rows, columns);
        for (Index j = 0; j < near.cols(); ++j)
            near.col(j) = at(correlation, u.square() + std::pow(static_cast<double>(j) * grid_.cell.y(), 2));
        for (Index j = 0; j < columns; ++j)
            for (Index i = 0; i < rows; ++i)
                for (Index q = 0; q < 5; ++q)
                    for (Index p = 0; p < 5; ++p)
                        between(i, j) += kFolded[static_cast<std::size_t>(p)] * kFolded[static_cast<std::size_t>(q)] *
                                         near(std::abs(i + p - 2), std::abs(j + q - 2));
        for (Index c = 0; c < sum.cols(); ++c)
            for (Index r = c; r < sum.rows(); ++r)
                sum(r, c) += factor * between(std::abs(r % rows - c % rows), r / rows - c / rows);
    }

  private:
    const Bspline& grid_;
    MatrixXd U_, V_; ///< rows: controls; columns: nodes
    Matrix2Xd nodes_;
};

/// Mean and covariance of the control heights. All amplitudes of one correlation share its decomposition: with the
/// trend F = Q R, K the touches' correlation, C the controls' with the touches and F_c the trend's controls over R,
///     mean = F_c Qᵀ z + B v,   v = (τ²/σ) (1 + (τ/σ)² λ)⁻¹ y,   B = (C - F_c Qᵀ K) E,
///     covariance = τ² (correlation - C Q F_cᵀ - F_c Qᵀ Cᵀ + F_c Qᵀ K Q F_cᵀ) + σ² F_c F_cᵀ - B τ⁴ (σ² + τ² λ)⁻¹ Bᵀ.
class Mixture {
  public:
    Mixture(const Problem& problem, const Controls& controls, const MatrixXd& F_controls)
        : problem_(problem), controls_(controls)
    {
        const Eigen::HouseholderQR<MatrixXd> qr(problem.F);
        const Index p = problem.F.cols();
        Q_ = qr.householderQ() * MatrixXd::Identity(problem.F.rows(), p);
        const MatrixXd R = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
        F_ = R.transpose().triangularView<Eigen::Lower>().solve(F_controls.transpose()).transpose();
        trend_ = F_ * (Q_.transpose() * problem.z);
        covariance_ = MatrixXd::Zero(controls.size(), controls.size());
    }

    /// @param weights  of the amplitudes
    void add(const Spectrum& s, const std::array<double, kRatios>& weights)
    {
        double sum = 0, tau2 = 0;
        const double sigma = problem_.sigma;
        VectorXd mean = VectorXd::Zero(s.y.size()), explained = mean;
        MatrixXd spread = MatrixXd::Zero(s.y.size(), s.y.size());
        for (int i = 0; i < kRatios; ++i) {
            const double weight = weights[static_cast<std::size_t>(i)];
            if (weight == 0) continue;
            const double ratio = ratio_of(i), t2 = std::pow(ratio * sigma, 2);
            const VectorXd d = precision(s, ratio), v = t2 / sigma * d.cwiseProduct(s.y);
            sum += weight;
            tau2 += weight * t2;
            explained += weight * t2 * ratio * ratio * d;
            mean += weight * v;
            spread.noalias() += weight * v * v.transpose();
        }
        if (sum == 0) return;
        mean /= sum;
        spread.noalias() -= sum * mean * mean.transpose();
        spread.diagonal() -= explained;

        const MatrixXd C = controls_.from(correlations(s.correlation, controls_.nodes(), problem_.xy));
        const MatrixXd QK = Q_.transpose() * correlations(s.correlation, problem_.xy, problem_.xy);
        const MatrixXd B = (C - F_ * QK) * s.E;
        const MatrixXd cross = tau2 * (F_ * (QK * Q_) / 2 - C * Q_) + sum * sigma * sigma / 2 * F_;
        MatrixXd left(B.rows(), B.cols() + 2 * F_.cols()), right(B.rows(), left.cols());
        left << B * spread, cross, F_;
        right << B, F_, cross;
        covariance_.triangularView<Eigen::Lower>() += left * right.transpose();
        controls_.add_correlation(covariance_, s.correlation, tau2);
        means_.push_back(trend_ + B * mean);
        sums_.push_back(sum);
    }

    /// @return  mean and covariance
    std::pair<VectorXd, MatrixXd> result() const
    {
        VectorXd mean = VectorXd::Zero(controls_.size());
        double sum = 0;
        for (std::size_t k = 0; k < means_.size(); ++k) {
            mean += sums_[k] * means_[k];
            sum += sums_[k];
        }
        mean /= sum;
        MatrixXd covariance = covariance_;
        for (std::size_t k = 0; k < means_.size(); ++k)
            covariance.selfadjointView<Eigen::Lower>().rankUpdate(means_[k] - mean, sums_[k]);
        covariance = MatrixXd(covariance.selfadjointView<Eigen::Lower>()) / sum;
        return {mean, covariance};
    }

  private:
    const Problem& problem_;
    const Controls& controls_;
    MatrixXd Q_, F_;
    VectorXd trend_;
    MatrixXd covariance_; ///< of the correlations about their means, times their weights; its lower half
    std::vector<VectorXd> means_;
    std::vector<double> sums_;
};

} // namespace

std::optional<Candidate> fit_process(const Touched& touched, const Bspline& grid)
{
    std::optional<FamilySolution> trend = solve_family("quadratic", touched, all_touches(touched));
    if (!trend) trend = solve_family("plane", touched, all_touches(touched));
    constexpr Index kRest = 2; // touches that nothing has taken up yet
    if (!trend || touched.xyz.cols() < trend->gradients.rows() + kRest) return std::nullopt;
    const Problem all{touched.xyz.topRows(2), touched.xyz.row(2).transpose(), touched.sigma,
                      trend->gradients.transpose()};
    const Controls controls(grid);
    const MatrixXd F_controls = controls.from(height_gradients(trend->shape, controls.nodes()).transpose());

    Columns kept = all_touches(touched);
    Problem problem = all;
    const auto most_slips =
        static_cast<std::size_t>(std::min(touched.xyz.cols() - all.F.cols() - kRest, touched.xyz.cols() / 4));
    Candidate candidate;
    candidate.method = "gp";
    std::vector<Spectrum> believed = spectra(problem);
    while (candidate.gross_errors.size() < most_slips) {
        const Index worst = worst_slip(believed, touched.sigma);
        if (worst < 0) break;
        candidate.gross_errors.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        problem = part_of(all, kept);
        believed = spectra(problem);
    }
    std::sort(candidate.gross_errors.begin(), candidate.gross_errors.end());

    // Their mean by probability.
    constexpr double kLeastWeight = 0.01; // of the most probable one
    const double best = best_score(believed);
    double sum = 0;
    Mixture mixture(problem, controls, F_controls);
    for (const Spectrum& s : believed) {
        std::array<double, kRatios> weights;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double weight = std::exp((best - s.score[i]) / 2);
            sum += weight;
            weights[i] = weight < kLeastWeight ? 0 : weight;
        }
        mixture.add(s, weights);
    }
    Bspline spline = grid;
    VectorXd heights;
    std::tie(heights, candidate.covariance) = mixture.result();
    spline.heights = heights.reshaped(grid.heights.rows(), grid.heights.cols());
    candidate.shape = std::move(spline);
    candidate.score = best - 2 * std::log(sum / static_cast<double>(believed.size() * kRatios)) +
                      price_of_a_slip(touched.sigma) * static_cast<double>(candidate.gross_errors.size());
    candidate.freedom = static_cast<double>(kept.size()) - static_cast<double>(all.F.cols());
    return candidate;
}

} // namespace fettle
