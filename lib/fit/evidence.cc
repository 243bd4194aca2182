#include "fit/evidence.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ln of τ where g at the touches is a fiftieth of the noise (all smaller ones are alike), and a million times it.
constexpr double kLeast = -4;
constexpr double kMost = 14;
constexpr int kSteps = 37; // half a unit each: the likelihood is a smooth function of ln τ

/// Over the τ of a grid.
struct Likelihood {
    VectorXd tau;
    VectorXd log_all; ///< ln p(z | τ) without its constant
    MatrixXd log_one; ///< (i, k): ln p(z_i | the others, τ_k)
};

FieldModel part_of(const FieldModel& model, const std::vector<Index>& kept)
{
    return {model.free(kept, Eigen::all), model.prior(kept, kept), model.R(kept, kept), model.sigma, model.least_tau};
}

// With C = σ² I + prior + τ² R, F the free columns and P = C⁻¹ - C⁻¹F (FᵀC⁻¹F)⁻¹ FᵀC⁻¹ (Harville 1977):
//     ln p(z | τ) = -½ (ln |C| + ln |FᵀC⁻¹F| + zᵀPz) - (n - columns of F)/2 ln 2π,
// and given the others z_i is normal with variance 1/P_ii and deviates by (Pz)_i / P_ii (Wahba 1990, 4.2).
void likelihood_at(const FieldModel& model, const VectorXd& z, Index k, Likelihood& result)
{
    const Index n = z.size();
    MatrixXd C = model.prior + result.tau[k] * result.tau[k] * model.R;
    C.diagonal().array() += model.sigma * model.sigma;
    const Eigen::LLT<MatrixXd> c(C);
    const MatrixXd inverse = c.solve(MatrixXd::Identity(n, n));
    const MatrixXd CF = inverse * model.free;
    const Eigen::LLT<MatrixXd> f(model.free.transpose() * CF);
    const MatrixXd P = inverse - CF * f.solve(CF.transpose());
    const VectorXd Pz = P * z;
    const auto half_log_det = [](const Eigen::LLT<MatrixXd>& factor) {
        return MatrixXd(factor.matrixLLT()).diagonal().array().log().sum();
    };
    const double log_2pi = std::log(2 * std::numbers::pi);
    result.log_all[k] =
        -half_log_det(c) - half_log_det(f) - z.dot(Pz) / 2 - static_cast<double>(n - model.free.cols()) / 2 * log_2pi;
    const Eigen::ArrayXd precision = P.diagonal().array();
    result.log_one.col(k) = (precision.log() - Pz.array().square() / precision - log_2pi) / 2;
}

Likelihood likelihood(const FieldModel& model, const VectorXd& z)
{
    Likelihood result;
    const double noise = model.sigma / std::sqrt(model.R.diagonal().maxCoeff());
    result.tau = noise * VectorXd::LinSpaced(kSteps, kLeast, kMost).array().exp();
    result.log_all.resize(kSteps);
    result.log_one.resize(z.size(), kSteps);
    for (Index k = 0; k < kSteps; ++k) {
        likelihood_at(model, z, k, result);
        // e times smaller than expected counts as one standard deviation.
        const double below = std::max(0.0, std::log(model.least_tau / result.tau[k]));
        result.log_all[k] -= below * below / 2;
    }
    return result;
}

double log_sum(const VectorXd& logarithms)
{
    const double most = logarithms.maxCoeff();
    return most + std::log((logarithms.array() - most).exp().sum());
}

/// The touch that is better explained as a gross error, most of all; -1 if there is none.
Index worst_error(const Likelihood& all)
{
    // A gross error: one touch in a hundred, and then anywhere within an inch (chips, a slipped probe).
    constexpr double kShare = 0.01;
    constexpr double kWidth = 25.4; // mm
    const double as_error = std::log(kShare / (1 - kShare)) - std::log(kWidth);
    const double as_touches = log_sum(all.log_all);
    Index worst = -1;
    double best_gain = 0;
    for (Index i = 0; i < all.log_one.rows(); ++i) {
        const double gain = log_sum(all.log_all - all.log_one.row(i).transpose()) + as_error - as_touches;
        if (gain > best_gain) {
            best_gain = gain;
            worst = i;
        }
    }
    return worst;
}

} // namespace

Amplitude amplitude(const FieldModel& model, const VectorXd& z, Index spare)
{
    Amplitude result;
    std::vector<Index> kept(static_cast<std::size_t>(z.size()));
    std::iota(kept.begin(), kept.end(), Index{0});
    Likelihood current = likelihood(model, z);
    while (static_cast<Index>(kept.size()) - model.free.cols() > spare) {
        const Index worst = worst_error(current);
        if (worst < 0) break;
        result.gross_errors.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        current = likelihood(part_of(model, kept), z(kept));
    }
    const Eigen::ArrayXd weight = (current.log_all.array() - current.log_all.maxCoeff()).exp();
    result.rms = std::sqrt((weight * current.tau.array().square()).sum() / weight.sum());
    return result;
}

} // namespace fettle
