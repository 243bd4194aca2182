#include "margin/waves.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "fit/correlation.h"
#include "surface/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace fettle::margin {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What is believed of the waves about a family before it is touched.
struct WavePrior {
    double share;                     ///< of the parts that have some
    std::array<double, 3> amplitudes; ///< over the standard deviation of a touch, all alike
};
constexpr WavePrior kCommonPrior = {0.08, {0.5, 1, 2}};
constexpr WavePrior kCubicPrior = {0.9, {1, 2, 4}};
constexpr std::array kLengths = {0.25, 0.5, 1.0}; // over the touches' radius, all alike
/// Waves less probable than this change the margin by less than the scatter of the draws.
constexpr double kMinProbability = 1e-3;
// Of the mean variance, added so that rounding leaves the covariance of neighbouring heights positive.
constexpr double kJitter = 1e-6;

Eigen::Matrix3Xd inliers(const surface::Surface& surface)
{
    std::vector<Index> kept;
    for (Index i = 0; i < surface.touches.cols(); ++i)
        if (std::find(surface.outliers.begin(), surface.outliers.end(), i) == surface.outliers.end()) kept.push_back(i);
    return surface.touches(Eigen::all, kept);
}

/// The family to first order: heights at the touches and at xy by coefficients of which the touches know each as well
/// as one touch its height. All in standard deviations of a touch.
struct Trend {
    MatrixXd at_touches, at_xy;
    VectorXd residuals;
};

Trend trend_of(const surface::WeightedShape& member, const Eigen::Matrix3Xd& touches, double sigma,
               const Eigen::Matrix2Xd& xy)
{
    constexpr double kMinVariance =
        1e-6; // of a direction: less is rounding, or a change that the family does not allow
    const Eigen::Matrix2Xd places = touches.topRows<2>();
    const VectorXd size = member.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    const VectorXd inverse = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
    const core::SymmetricEigen<Eigen::Dynamic> axes =
        core::symmetric_eigen<Eigen::Dynamic>(inverse.asDiagonal() * member.covariance * inverse.asDiagonal());
    const MatrixXd root = size.asDiagonal() * axes.vectors * axes.values.cwiseMax(0).cwiseSqrt().asDiagonal() / sigma;
    const MatrixXd all = surface::height_gradients(member.shape, places).transpose() * root;
    const core::SymmetricEigen<Eigen::Dynamic> known = core::symmetric_eigen<Eigen::Dynamic>(all.transpose() * all);
    const Index free = (known.values.array() > kMinVariance * known.values.maxCoeff()).count();
    const MatrixXd turn = known.vectors.rightCols(free);
    return {all * turn, surface::height_gradients(member.shape, xy).transpose() * root * turn,
            (touches.row(2).transpose() - surface::heights(member.shape, places)) / sigma};
}

/// V of the touches in the model z = F β + g + e, and what follows of it.
struct Kriging {
    MatrixXd inverse;          ///< V⁻¹
    MatrixXd beta;             ///< (Fᵀ V⁻¹ F)⁻¹, the covariance of β
    VectorXd estimate;         ///< of β
    double log_likelihood = 0; ///< restricted, without its constant
};

Kriging kriging(const MatrixXd& V, const Trend& trend)
{
    const MatrixXd& F = trend.at_touches;
    const auto half_log_det = [](const core::Cholesky& factor) { return factor.L().diagonal().array().log().sum(); };
    const core::Cholesky v(V);
    Kriging result;
    result.inverse = v.solve(MatrixXd::Identity(V.rows(), V.cols()));
    const core::Cholesky information(F.transpose() * result.inverse * F);
    result.beta = information.solve(MatrixXd::Identity(F.cols(), F.cols()));
    const VectorXd weighted = result.inverse * trend.residuals, sums = F.transpose() * weighted;
    result.estimate = result.beta * sums;
    result.log_likelihood =
        -half_log_det(v) - half_log_det(information) - (trend.residuals.dot(weighted) - sums.dot(result.estimate)) / 2;
    return result;
}

WavePrior prior_of(const surface::Shape& shape)
{
    const auto* polynomial = std::get_if<surface::Polynomial>(&shape);
    return polynomial != nullptr && polynomial->coefficients.size() > surface::monomial_count(2) ? kCubicPrior
                                                                                                 : kCommonPrior;
}

/// Waves of one amplitude and one length.
struct Model {
    fit::Correlation correlation;
    double variance; ///< over that of a touch
    Kriging kriging;
    double probability = 0; ///< after the touches, if the part is of the family
};

std::vector<Model> models_of(const WavePrior& prior, const Eigen::Matrix2Xd& places, double radius, const Trend& trend)
{
    const MatrixXd noise = MatrixXd::Identity(places.cols(), places.cols());
    const double without = kriging(noise, trend).log_likelihood;
    std::vector<Model> models;
    double max = without;
    for (const double length : kLengths) {
        const fit::Correlation correlation{fit::Kernel::matern52, length * radius};
        const MatrixXd K = fit::correlation_matrix(correlation, places, places);
        for (const double amplitude : prior.amplitudes) {
            const double variance = amplitude * amplitude;
            models.push_back({correlation, variance, kriging(variance * K + noise, trend)});
            max = std::max(max, models.back().kriging.log_likelihood);
        }
    }
    double sum = (1 - prior.share) * std::exp(without - max);
    for (Model& model : models) {
        model.probability = prior.share / double(models.size()) * std::exp(model.kriging.log_likelihood - max);
        sum += model.probability;
    }
    for (Model& model : models) model.probability /= sum;
    return models;
}

/// @param weights  of the touches' residuals in the waves at xy
Waves waves_of(const Model& model, const Trend& trend, const MatrixXd& weights, const Eigen::Matrix2Xd& places,
               const Eigen::Matrix2Xd& xy, double sigma)
{
    const MatrixXd rest = trend.at_xy - weights * trend.at_touches;
    MatrixXd covariance = model.variance * fit::correlation_matrix(model.correlation, xy, xy) -
                          model.variance * weights * fit::correlation_matrix(model.correlation, places, xy) +
                          rest * model.kriging.beta * rest.transpose();
    covariance.diagonal().array() += kJitter * covariance.diagonal().mean();
    const VectorXd mean = rest * model.kriging.estimate + weights * trend.residuals;
    return {model.probability, sigma * mean, sigma * core::Cholesky(covariance).L()};
}

} // namespace

std::vector<Waves> waves_about(const surface::WeightedShape& member, const surface::Surface& surface,
                               const Eigen::Matrix2Xd& xy)
{
    const Eigen::Matrix3Xd touches = inliers(surface);
    const double sigma = surface.touch_sigma;
    if (touches.cols() == 0 || !(sigma > 0)) return {};
    const Eigen::Matrix2Xd places = touches.topRows<2>();
    const double radius = (places.colwise() - places.rowwise().mean().eval()).colwise().norm().maxCoeff();
    const Trend trend = trend_of(member, touches, sigma, xy);
    if (trend.at_touches.cols() >= touches.cols() || !trend.at_touches.allFinite() || !trend.at_xy.allFinite() ||
        !trend.residuals.allFinite() || !(radius > 0))
        return {};
    const std::vector<Model> models = models_of(prior_of(member.shape), places, radius, trend);
    std::vector<Waves> all;
    for (const Model& model : models) {
        if (!(model.probability > kMinProbability)) continue;
        const MatrixXd weights =
            model.variance * fit::correlation_matrix(model.correlation, xy, places) * model.kriging.inverse;
        all.push_back(waves_of(model, trend, weights, places, xy, sigma));
    }
    return all;
}

} // namespace fettle::margin
