#include "fit/family.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "fit/trimmed_touches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Applies to columns of unit length: combinations of parameters that move the touches by less are undetermined.
constexpr double kRankThreshold = 1e-6;
// Leverages closer to 1 than this are rounding errors: the fit follows such a touch whatever its height.
constexpr double kMinRedundancy = 1e-6;
constexpr double kMinGoodness = 1e-3; // p-value: inliers of a surface of the family look worse once in a thousand fits
constexpr double kMaxOutlierShare = 0.25;

/// Residuals and covariances of a solution at all touches.
struct Evaluation {
    VectorXd chi;        ///< r/σ
    VectorXd leverage;   ///< σ(fitted height)²/σ²; for kept touches the diagonal of the hat matrix
    MatrixXd hat_root;   ///< W with Wᵀ W the hat matrix, the heights' derivatives by those of the kept touches
    MatrixXd covariance; ///< of θ over σ²
    Index parameters = 0;
};

std::optional<Evaluation> evaluate(const FamilySolution& solution, const TouchSet& touches, const TouchIndices& kept)
{
    if (!solution.gradients.allFinite()) return std::nullopt;
    const MatrixXd& free = solution.free_directions;
    const MatrixXd G = free.size() > 0 ? free.transpose() * solution.gradients : solution.gradients;
    const MatrixXd J = G(Eigen::all, kept).transpose();
    const VectorXd size = J.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const std::optional<MatrixXd> scaled =
        core::inverse_gram_factor(J * size.cwiseInverse().asDiagonal(), kRankThreshold);
    if (!scaled) return std::nullopt;
    const MatrixXd root = size.cwiseInverse().asDiagonal() * *scaled;
    Evaluation result;
    result.covariance = root * root.transpose();
    result.parameters = J.cols();
    if (free.size() > 0) result.covariance = free * result.covariance * free.transpose();
    result.hat_root = root.transpose() * G;
    result.leverage = result.hat_root.colwise().squaredNorm();
    result.chi =
        (touches.xyz.row(2).transpose() - surface::heights(solution.shape, touches.xyz.topRows(2))) / touches.sigma;
    if (!result.chi.allFinite()) return std::nullopt;
    return result;
}

/// The touch whose change between inlier and outlier lowers the score most; -1 if none lowers it.
Index best_change(const Evaluation& fit, const std::vector<char>& is_kept, bool may_reject, double penalty)
{
    Index best = -1;
    double best_gain = 1e-9 * penalty; // more than rounding, which could repeat changes endlessly
    for (Index i = 0; i < fit.chi.size(); ++i) {
        const double chi2 = fit.chi[i] * fit.chi[i];
        double gain = 0;
        if (is_kept[i] == 0)
            gain = penalty - chi2 / (1 + fit.leverage[i]);
        else if (may_reject && fit.leverage[i] < 1 - kMinRedundancy)
            gain = chi2 / (1 - fit.leverage[i]) - penalty;
        if (gain > best_gain) {
            best_gain = gain;
            best = i;
        }
    }
    return best;
}

TouchIndices indices_of(const std::vector<char>& marks, char mark)
{
    TouchIndices indices;
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] == mark) indices.push_back(i);
    return indices;
}

/// A family fitted to the kept touches.
struct FamilyFit {
    FamilySolution solution;
    Evaluation evaluation;
    std::vector<char> is_kept;
    double chi2 = 0, freedom = 0;
    int iterations = 0;
};

/// @param near  minima for almost the same touches   @param iterations  of the fits before
std::optional<FamilyFit> fit_kept(const std::string& name, const TouchSet& touches, std::vector<char> is_kept,
                                  const std::vector<RoundMinimum>& near, int iterations)
{
    const TouchIndices kept = indices_of(is_kept, 1);
    std::optional<FamilySolution> solution = solve_family(name, touches, kept, near);
    if (!solution) return std::nullopt;
    std::optional<Evaluation> evaluation = evaluate(*solution, touches, kept);
    if (!evaluation) return std::nullopt;
    const double chi2 = evaluation->chi(kept).squaredNorm();
    const double freedom = static_cast<Index>(kept.size()) - evaluation->parameters;
    iterations += solution->iterations;
    return FamilyFit{std::move(*solution), std::move(*evaluation), std::move(is_kept), chi2, freedom, iterations};
}

/// True if the inliers would not nearly fit even without the `max_outliers` worst touches. As far as heights are linear
/// in θ, the residuals without touch i are r - P_i r_i / P_ii, P_i the i-th column of P = I - WᵀW, and P changes
/// likewise (Cook and Weisberg 1982, 2.2).
bool cannot_fit(const FamilyFit& start, Index max_outliers)
{
    constexpr double kNonlinearityFactor = 3; // factor of χ² to allow for heights that are not linear in θ
    const TouchIndices kept = indices_of(start.is_kept, 1);
    const MatrixXd W = start.evaluation.hat_root(Eigen::all, kept);
    MatrixXd P = -W.transpose() * W;
    P.diagonal().array() += 1;
    VectorXd r = start.evaluation.chi(kept);
    double chi2 = start.chi2;
    for (Index outliers = 0; outliers < max_outliers; ++outliers) {
        Index worst = -1;
        const Eigen::ArrayXd redundancy = P.diagonal().array();
        const double gain = (redundancy > kMinRedundancy).select(r.array().square() / redundancy, 0).maxCoeff(&worst);
        if (!(gain > 0)) break;
        const VectorXd column = P.col(worst) / P(worst, worst);
        r -= column * r[worst];
        P -= column * P.row(worst).eval();
        P(worst, worst) = 0;
        chi2 -= gain;
    }
    return chi2_p_value(std::max(chi2, 0.0) / kNonlinearityFactor, start.freedom) < kMinGoodness;
}

/// Rejects outliers and takes touches back one by one. @return  nothing if the family does not fit: if there are too
/// many outliers or the inliers do not agree with their noise
std::optional<FamilyFit> reject_outliers(const std::string& name, const TouchSet& touches, FamilyFit fit)
{
    const Index n = touches.xyz.cols();
    const auto max_outliers = static_cast<std::ptrdiff_t>(kMaxOutlierShare * n);
    const double penalty = outlier_penalty(touches.sigma, touches.freedom);
    if (cannot_fit(fit, max_outliers)) return std::nullopt;
    for (Index change = 0; change <= 2 * n; ++change) { // touches may alternate endlessly
        const std::ptrdiff_t outliers = std::count(fit.is_kept.begin(), fit.is_kept.end(), 0);
        const Index i = best_change(fit.evaluation, fit.is_kept, fit.freedom > 1, penalty);
        if (i < 0) {
            const bool fits = outliers <= max_outliers && chi2_p_value(fit.chi2, fit.freedom) >= kMinGoodness;
            return outliers == 0 || fits ? std::optional(std::move(fit)) : std::nullopt;
        }
        if (outliers > max_outliers && fit.is_kept[i] != 0) return std::nullopt;
        fit.is_kept[i] ^= 1;
        std::optional<FamilyFit> next =
            fit_kept(name, touches, std::move(fit.is_kept), fit.solution.minima, fit.iterations);
        if (!next) return std::nullopt;
        fit = std::move(*next);
    }
    return std::nullopt;
}

} // namespace

TouchSet make_touch_set(const surface::Surface& surface, const job::Job& job)
{
    return {surface.touches, surface.touch_sigma, job.theta + job.ruling_direction,
            job.surface == job::SurfaceType::swept, surface.touch_sigma_dof};
}

TouchIndices all_touches(const TouchSet& touches)
{
    TouchIndices all(touches.xyz.cols());
    std::iota(all.begin(), all.end(), Index{0});
    return all;
}

double outlier_penalty(double sigma, double freedom)
{
    // Outlier model: one touch in twenty, uniformly distributed over an inch (chips, dust, the anomaly's foot).
    constexpr double kOutlierShare = 0.05;
    constexpr double kOutlierRange = 25.4; // mm
    const double penalty =
        -2 * std::log(kOutlierShare / (1 - kOutlierShare) * sigma * std::sqrt(2 * std::numbers::pi) / kOutlierRange);
    return std::isfinite(freedom) ? freedom * std::expm1(penalty / (freedom + 1)) : penalty;
}

std::optional<FitCandidate> fit_family(const std::string& name, const TouchSet& touches, const TouchIndices& kept)
{
    const std::size_t n = touches.xyz.cols();
    std::vector<char> is_kept(n, 0);
    for (const Index i : kept) is_kept[i] = 1;
    std::optional<FamilyFit> start = fit_kept(name, touches, is_kept, {}, 0);
    std::optional<FamilyFit> best = start ? reject_outliers(name, touches, *start) : std::nullopt;
    if (!best && start && kept.size() == n) best = std::move(start);
    if (!best) return std::nullopt;
    FitCandidate candidate;
    candidate.method = name;
    candidate.outliers = indices_of(best->is_kept, 0);
    candidate.shape = std::move(best->solution.shape);
    candidate.covariance = touches.sigma * touches.sigma * best->evaluation.covariance;
    candidate.chi2 = best->chi2;
    candidate.freedom = best->freedom;
    candidate.converged = best->solution.converged;
    candidate.iterations = best->iterations;
    candidate.score = candidate.chi2 + best->evaluation.parameters * std::log(n) +
                      outlier_penalty(touches.sigma, touches.freedom) * candidate.outliers.size();
    return candidate;
}

void refuse_undetermined(const TouchSet& touches, const std::string& name, const std::string& source)
{
    if (!solve_family("plane", touches, all_touches(touches)))
        throw core::InputError(source, "touches lie on one line in x and y");
    throw core::InputError(source, "touches do not determine a " + name + ": more than one fits them");
}

Fit fit_family_by_name(const FitInput& input, const std::string& name)
{
    static const std::map<std::string, int> min_touches = {
        {"sphere", 4},  {"cylinder", 5},  {"cone", 6},   {"torus", 7},    {"ellipsoid", 6},
        {"quadric", 9}, {"quadratic", 6}, {"cubic", 10}, {"quartic", 15}, {"swept", 5}};
    surface::Surface surface = begin_surface(input, name, kSampleRoles, min_touches.at(name));
    const TouchSet touches = make_touch_set(surface, input.job);
    std::optional<FitCandidate> best = fit_family(name, touches, all_touches(touches));
    if (best && (!best->outliers.empty() || chi2_p_value(best->chi2, best->freedom) < kMinGoodness)) {
        std::optional<FitCandidate> trimmed = fit_family(name, touches, trimmed_touches(touches));
        if (trimmed && trimmed->score < best->score) best = std::move(trimmed);
    }
    if (!best) refuse_undetermined(touches, name, input.source);
    surface.shape = std::move(best->shape);
    surface.covariance = std::move(best->covariance);
    surface.outliers = std::move(best->outliers);
    const double freedom_of_all = best->freedom + surface.outliers.size();
    return finish_fit(std::move(surface), freedom_of_all, best->converged, best->iterations);
}

} // namespace fettle::fit
