#include "fit/evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What is left of the touches when the free β is projected out: orthonormal contrasts, so that noise stays σ² I.
struct Contrasts {
    VectorXd z;
    MatrixXd fixed; ///< σ² I and the prior of β
    MatrixXd R;
    double scale = 0;        ///< amplitude at which g is as large as the noise
    double half_log_det = 0; ///< ln √|HᵀH| of the free columns: how much of the touches they explain
};

Contrasts contrasts(const FieldModel& model, const VectorXd& z)
{
    const Index n = z.size();
    const Index free = model.free.cols();
    const Eigen::HouseholderQR<MatrixXd> qr(model.free);
    const MatrixXd all = qr.householderQ();
    const MatrixXd U = all.rightCols(n - free);
    Contrasts result;
    result.z = U.transpose() * z;
    result.fixed = U.transpose() * model.prior * U;
    result.fixed.diagonal().array() += model.sigma * model.sigma;
    result.R = U.transpose() * model.R * U;
    result.scale = model.sigma / std::sqrt(std::max(result.R.diagonal().maxCoeff(), 1e-300));
    result.half_log_det = qr.matrixQR().diagonal().array().abs().log().sum();
    return result;
}

/// log p of the contrasts, without its constant.
double log_likelihood(const Contrasts& c, double tau)
{
    const Eigen::LLT<MatrixXd> factor(c.fixed + tau * tau * c.R);
    const double half_log_det = MatrixXd(factor.matrixL()).diagonal().array().log().sum();
    return -c.half_log_det - half_log_det - factor.matrixL().solve(c.z).squaredNorm() / 2;
}

struct Peak {
    double tau = 0;
    double log_likelihood = -std::numeric_limits<double>::infinity();
};

/// Over a range of amplitudes from g far below the noise to noise far below g: a coarse scan, as there may be two peaks
/// (all is g, all is noise), then golden sections.
Peak peak(const Contrasts& c)
{
    constexpr double kLeast = -7; // ln: g is a thousandth of the noise
    constexpr double kMost = 14;  // ln: a million times the noise
    constexpr double kCoarse = 1;
    constexpr double kFine = 0.02; // 2 % of the amplitude change the surface by far less
    const auto at = [&](double log_tau) { return log_likelihood(c, c.scale * std::exp(log_tau)); };
    double best = kLeast;
    double most = at(kLeast);
    for (double x = kLeast + kCoarse; x <= kMost; x += kCoarse)
        if (const double value = at(x); value > most) {
            best = x;
            most = value;
        }
    const double golden = (std::sqrt(5.0) - 1) / 2;
    double low = std::max(kLeast, best - kCoarse);
    double high = std::min(kMost, best + kCoarse);
    while (high - low > kFine) {
        const double step = golden * (high - low);
        if (at(high - step) > at(low + step))
            high = low + step;
        else
            low = high - step;
    }
    // At the lower end g vanishes: stay there rather than a step beside it.
    const double x = best == kLeast ? kLeast : (low + high) / 2;
    return {c.scale * std::exp(x), at(x)};
}

} // namespace

double most_probable_amplitude(const FieldModel& model, const VectorXd& z) { return peak(contrasts(model, z)).tau; }

FieldModel part_of(const FieldModel& model, const std::vector<Index>& kept)
{
    return {model.free(kept, Eigen::all), model.prior(kept, kept), model.R(kept, kept), model.sigma};
}

std::vector<Index> gross_errors(const FieldModel& model, const VectorXd& z, Index spare)
{
    // A gross error: one touch in a hundred, and then anywhere within an inch (chips, a slipped probe).
    constexpr double kShare = 0.01;
    constexpr double kWidth = 25.4; // mm
    const double odds = std::log(kShare / (1 - kShare)) - std::log(kWidth) + std::log(2 * M_PI) / 2;
    std::vector<Index> kept(static_cast<std::size_t>(z.size()));
    std::iota(kept.begin(), kept.end(), Index{0});
    std::vector<Index> gross;
    double with_all = peak(contrasts(model, z)).log_likelihood;
    while (static_cast<Index>(kept.size()) - model.free.cols() > spare) {
        Index worst = -1;
        double best = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < kept.size(); ++i) {
            std::vector<Index> others = kept;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            const double without = peak(contrasts(part_of(model, others), z(others))).log_likelihood;
            if (without > best) {
                best = without;
                worst = static_cast<Index>(i);
            }
        }
        if (best + odds <= with_all) break;
        gross.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        with_all = best;
    }
    return gross;
}

} // namespace fettle
