#include "fit/evidence.h"

#include "core/cholesky.h"
#include "fit/leave_one_out.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Range of ln of g's rms at the touches over the noise: from a fiftieth of the noise, below which the likelihood is
// constant, to a million times the noise.
constexpr double kMinLogRatio = -4;
constexpr double kMaxLogRatio = 14;
constexpr int kGridPoints = 37; // half a unit each: the likelihood is a smooth function of ln τ

/// Likelihood over a grid of τ.
struct Likelihood {
    VectorXd tau;
    VectorXd log_all;  ///< ln p(z | τ) without its constant
    LeaveOneOut touch; ///< its models are the values of τ
};

FieldModel subset_of(const FieldModel& model, const std::vector<Index>& kept)
{
    return {model.fixed_effects(kept, Eigen::all), model.effect_covariance(kept, kept), model.R(kept, kept),
            model.sigma, model.min_tau};
}

// With C = σ² I + effect_covariance + τ² R, F the fixed effects and P = C⁻¹ - C⁻¹F (FᵀC⁻¹F)⁻¹ FᵀC⁻¹ (Harville 1977):
//     ln p(z | τ) = -½ (ln |C| + ln |FᵀC⁻¹F| + zᵀPz) - (n - columns of F)/2 ln 2π,
// and given the others z_i is normal with variance 1/P_ii and deviates by (Pz)_i / P_ii (Wahba 1990, 4.2).
void likelihood_at(const FieldModel& model, const VectorXd& z, Index k, Likelihood& result)
{
    const Index n = z.size();
    MatrixXd C = model.effect_covariance + result.tau[k] * result.tau[k] * model.R;
    C.diagonal().array() += model.sigma * model.sigma;
    const core::Cholesky c(C);
    const MatrixXd inverse = c.solve(MatrixXd::Identity(n, n));
    const MatrixXd CF = inverse * model.fixed_effects;
    const core::Cholesky f(model.fixed_effects.transpose() * CF);
    const MatrixXd P = inverse - CF * f.solve(CF.transpose());
    const VectorXd Pz = P * z;
    const auto half_log_det = [](const core::Cholesky& factor) { return factor.L().diagonal().array().log().sum(); };
    const double log_2pi = std::log(2 * std::numbers::pi);
    result.log_all[k] =
        -half_log_det(c) - half_log_det(f) - z.dot(Pz) / 2 - (n - model.fixed_effects.cols()) / 2.0 * log_2pi;
    result.touch.variance.col(k) = P.diagonal().cwiseInverse();
    result.touch.deviation.col(k) = Pz.cwiseQuotient(P.diagonal());
}

Likelihood likelihood(const FieldModel& model, const VectorXd& z)
{
    Likelihood result;
    const double noise = model.sigma / std::sqrt(model.R.diagonal().maxCoeff());
    result.tau = noise * VectorXd::LinSpaced(kGridPoints, kMinLogRatio, kMaxLogRatio).array().exp();
    result.log_all.resize(kGridPoints);
    result.touch.deviation.resize(z.size(), kGridPoints);
    result.touch.variance.resize(z.size(), kGridPoints);
    for (Index k = 0; k < kGridPoints; ++k) {
        likelihood_at(model, z, k, result);
        // The prior falls off below min_tau as a normal density in ln τ with standard deviation 1.
        const double below = std::max(0.0, std::log(model.min_tau / result.tau[k]));
        result.log_all[k] -= below * below / 2;
    }
    // ln p(the others | τ) = ln p(z | τ) - ln p(z_i | the others, τ)
    const Eigen::ArrayXXd variance = result.touch.variance.array();
    result.touch.log_weight = (result.touch.deviation.array().square() / variance + variance.log()) / 2;
    result.touch.log_weight.rowwise() += result.log_all.transpose();
    return result;
}

Index worst_outlier(const Likelihood& all)
{
    // Outlier model: one touch in a hundred, uniformly distributed over an inch (chips, a slipped probe).
    constexpr double kOutlierShare = 0.01;
    constexpr double kOutlierRange = 25.4; // mm
    return most_probable_outlier(all.touch, std::log(kOutlierShare / (1 - kOutlierShare)) - std::log(kOutlierRange));
}

} // namespace

Amplitude estimate_amplitude(const FieldModel& model, const VectorXd& z, Index min_redundancy)
{
    Amplitude result;
    std::vector<Index> kept(z.size());
    std::iota(kept.begin(), kept.end(), Index{0});
    Likelihood current = likelihood(model, z);
    while (static_cast<Index>(kept.size()) - model.fixed_effects.cols() > min_redundancy) {
        const Index worst = worst_outlier(current);
        if (worst < 0) break;
        result.outliers.push_back(kept[worst]);
        kept.erase(kept.begin() + worst);
        current = likelihood(subset_of(model, kept), z(kept));
    }
    const Eigen::ArrayXd weight = (current.log_all.array() - current.log_all.maxCoeff()).exp();
    result.rms = std::sqrt((weight * current.tau.array().square()).sum() / weight.sum());
    return result;
}

} // namespace fettle::fit
