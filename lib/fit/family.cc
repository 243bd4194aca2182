#include "fit/family.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "fit/trimmed_touches.h"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of columns of unit length: a combination of parameters that moves the touches by less is not determined.
constexpr double kRankThreshold = 1e-6;
// Of the touches that are no slips: one set in a thousand looks worse.
constexpr double kLeastGoodness = 1e-3;

/// A solution, seen from all touches.
struct Judged {
    VectorXd chi;      ///< r/σ
    VectorXd leverage; ///< of the kept: share of a touch's error that its fitted height follows; others: σ(height)²/σ²
    MatrixXd moves;    ///< W: Wᵀ W is by how much the heights follow the errors of the kept touches
    MatrixXd covariance; ///< of θ over σ²
    Index parameters = 0;
};

std::optional<Judged> judge(const FamilySolution& solution, const Touched& touched, const Columns& kept)
{
    if (!solution.gradients.allFinite()) return std::nullopt;
    const MatrixXd G = solution.free.size() > 0 ? solution.free.transpose() * solution.gradients : solution.gradients;
    const MatrixXd J = G(Eigen::all, kept).transpose();
    const VectorXd size = J.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const std::optional<MatrixXd> scaled = root_of_inverse(J * size.cwiseInverse().asDiagonal(), kRankThreshold);
    if (!scaled) return std::nullopt;
    const MatrixXd root = size.cwiseInverse().asDiagonal() * *scaled;
    Judged judged;
    judged.covariance = root * root.transpose();
    judged.parameters = J.cols();
    if (solution.free.size() > 0) judged.covariance = solution.free * judged.covariance * solution.free.transpose();
    judged.moves = root.transpose() * G;
    judged.leverage = judged.moves.colwise().squaredNorm();
    judged.chi = (touched.xyz.row(2).transpose() - heights(solution.shape, touched.xyz.topRows(2))) / touched.sigma;
    if (!judged.chi.allFinite()) return std::nullopt;
    return judged;
}

/// The touch to leave out or to take back: the one that changes the score most. -1: none.
Index to_change(const Judged& judged, const std::vector<char>& is_kept, bool may_leave_out, double price)
{
    constexpr double kNoFreedom = 1e-6; // such a touch is followed whatever it says
    Index worst = -1;
    double best_gain = 1e-9 * price; // more than rounding, or it goes back and forth
    for (Index i = 0; i < judged.chi.size(); ++i) {
        const double chi2 = judged.chi[i] * judged.chi[i];
        double gain = 0;
        if (is_kept[static_cast<std::size_t>(i)] != 0)
            gain = may_leave_out && judged.leverage[i] < 1 - kNoFreedom ? chi2 / (1 - judged.leverage[i]) - price : 0;
        else
            gain = price - chi2 / (1 + judged.leverage[i]);
        if (gain > best_gain) {
            best_gain = gain;
            worst = i;
        }
    }
    return worst;
}

} // namespace

Touched touched_of(const Surface& surface, const Job& job)
{
    return {surface.touches, surface.touch_sigma, job.theta + job.direction, job.surface == SurfaceType::swept,
            surface.touch_freedom};
}

Columns all_touches(const Touched& touched)
{
    Columns all(static_cast<std::size_t>(touched.xyz.cols()));
    std::iota(all.begin(), all.end(), Index{0});
    return all;
}

double price_of_a_slip(double sigma, double freedom)
{
    // One touch in twenty, and then anywhere within an inch (chips, dust, the anomaly's foot).
    constexpr double kShare = 0.05;
    constexpr double kWidth = 25.4; // mm
    const double price = -2 * std::log(kShare / (1 - kShare) * sigma * std::sqrt(2 * std::numbers::pi) / kWidth);
    return std::isfinite(freedom) ? freedom * std::expm1(price / (freedom + 1)) : price;
}

double goodness(double chi2, double freedom)
{
    return freedom > 0 && std::isfinite(chi2) ? boost::math::gamma_q(freedom / 2, chi2 / 2) : 1;
}

namespace {

Columns marked(const std::vector<char>& marks, char mark)
{
    Columns columns;
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] == mark) columns.push_back(static_cast<Index>(i));
    return columns;
}

/// A family fitted to some of the touches.
struct Fitted {
    FamilySolution solution;
    Judged judged;
    std::vector<char> is_kept;
    double chi2 = 0, freedom = 0;
    int iterations = 0;
};

std::optional<Fitted> fitted(const std::string& name, const Touched& touched, std::vector<char> is_kept, int iterations)
{
    const Columns kept = marked(is_kept, 1);
    std::optional<FamilySolution> solution = solve_family(name, touched, kept);
    if (!solution) return std::nullopt;
    std::optional<Judged> judged = judge(*solution, touched, kept);
    if (!judged) return std::nullopt;
    const double chi2 = judged->chi(kept).squaredNorm();
    const double freedom = static_cast<double>(static_cast<Index>(kept.size()) - judged->parameters);
    iterations += solution->iterations;
    return Fitted{std::move(*solution), std::move(*judged), std::move(is_kept), chi2, freedom, iterations};
}

constexpr double kMostSlips = 0.25; // of the touches

/// Would the others not nearly fit, however many touches are taken for slips? As far as heights are linear in θ,
/// without touch i the residuals are r - P_i r_i / P_ii, P_i the i-th column of P = I - WᵀW, and P changes likewise
/// (Cook and Weisberg 1982, 2.2).
bool hopeless(const Fitted& start, Index most)
{
    constexpr double kNear = 3; // times the sum of squares that fits: room for what is not linear
    const Columns kept = marked(start.is_kept, 1);
    const MatrixXd W = start.judged.moves(Eigen::all, kept);
    MatrixXd P = -W.transpose() * W;
    P.diagonal().array() += 1;
    VectorXd r = start.judged.chi(kept);
    double chi2 = start.chi2;
    for (Index slips = 0; slips < most; ++slips) {
        constexpr double kNoFreedom = 1e-6;
        Index worst = -1;
        const Eigen::ArrayXd free = P.diagonal().array();
        const double gain = (free > kNoFreedom).select(r.array().square() / free, 0).maxCoeff(&worst);
        if (!(gain > 0)) break;
        const VectorXd column = P.col(worst) / P(worst, worst);
        r -= column * r[worst];
        P -= column * P.row(worst).eval();
        P(worst, worst) = 0;
        chi2 -= gain;
    }
    return goodness(std::max(chi2, 0.0) / kNear, start.freedom) < kLeastGoodness;
}

/// Slips left out, others taken back, one by one. Slips are few, and the other touches fit; else it is the family that
/// does not: nothing.
std::optional<Fitted> without_slips(const std::string& name, const Touched& touched, Fitted now)
{
    const auto n = static_cast<Index>(touched.xyz.cols());
    const auto most = static_cast<std::ptrdiff_t>(kMostSlips * static_cast<double>(n));
    const double price = price_of_a_slip(touched.sigma, touched.freedom);
    if (hopeless(now, most)) return std::nullopt;
    for (Index change = 0; change <= 2 * n; ++change) { // they might come and go in turns
        const std::ptrdiff_t slips = std::count(now.is_kept.begin(), now.is_kept.end(), 0);
        const Index i = to_change(now.judged, now.is_kept, now.freedom > 1, price);
        if (i < 0) {
            const bool explained = slips <= most && goodness(now.chi2, now.freedom) >= kLeastGoodness;
            return slips == 0 || explained ? std::optional(std::move(now)) : std::nullopt;
        }
        if (slips > most && now.is_kept[static_cast<std::size_t>(i)] != 0) return std::nullopt;
        now.is_kept[static_cast<std::size_t>(i)] ^= 1;
        std::optional<Fitted> next = fitted(name, touched, std::move(now.is_kept), now.iterations);
        if (!next) return std::nullopt;
        now = std::move(*next);
    }
    return std::nullopt;
}

} // namespace

std::optional<Candidate> fit_family(const std::string& name, const Touched& touched, const Columns& kept)
{
    const auto n = static_cast<std::size_t>(touched.xyz.cols());
    std::vector<char> is_kept(n, 0);
    for (const Index i : kept) is_kept[static_cast<std::size_t>(i)] = 1;
    std::optional<Fitted> start = fitted(name, touched, is_kept, 0);
    std::optional<Fitted> best = start ? without_slips(name, touched, *start) : std::nullopt;
    if (!best && start && kept.size() == n) best = std::move(start);
    if (!best) return std::nullopt;
    Candidate candidate;
    candidate.method = name;
    candidate.gross_errors = marked(best->is_kept, 0);
    candidate.shape = std::move(best->solution.shape);
    candidate.covariance = touched.sigma * touched.sigma * best->judged.covariance;
    candidate.chi2 = best->chi2;
    candidate.freedom = best->freedom;
    candidate.converged = best->solution.converged;
    candidate.iterations = best->iterations;
    const auto p = static_cast<double>(best->judged.parameters);
    candidate.score =
        candidate.chi2 + p * std::log(static_cast<double>(n)) +
        price_of_a_slip(touched.sigma, touched.freedom) * static_cast<double>(candidate.gross_errors.size());
    return candidate;
}

void refuse_undetermined(const Touched& touched, const std::string& name, const std::string& source)
{
    if (!solve_family("plane", touched, all_touches(touched)))
        throw InputError(source, "touches lie on one line in x and y");
    throw InputError(source, "touches do not determine a " + name + ": another one goes through them as well");
}

Fit fit_family_by_name(const FitInput& input, const std::string& name)
{
    static const std::map<std::string, int> least = {{"sphere", 4}, {"cylinder", 5}, {"cone", 6},
                                                     {"torus", 7},  {"quadric", 9},  {"quadratic", 6},
                                                     {"cubic", 10}, {"quartic", 15}, {"swept", 5}};
    Surface surface = begin_surface(input, name, kSampleRoles, least.at(name));
    const Touched touched = touched_of(surface, input.job);
    std::optional<Candidate> best = fit_family(name, touched, all_touches(touched));
    if (best && (!best->gross_errors.empty() || goodness(best->chi2, best->freedom) < kLeastGoodness)) {
        std::optional<Candidate> trimmed = fit_family(name, touched, trimmed_touches(touched));
        if (trimmed && trimmed->score < best->score) best = std::move(trimmed);
    }
    if (!best) refuse_undetermined(touched, name, input.source);
    surface.shape = std::move(best->shape);
    surface.covariance = std::move(best->covariance);
    surface.gross_errors = std::move(best->gross_errors);
    const double all = best->freedom + static_cast<double>(surface.gross_errors.size());
    return finish_fit(std::move(surface), all, best->converged, best->iterations);
}

} // namespace fettle
