#include "margin/waves.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "fit/correlation.h"
#include "fit/family.h"
#include "surface/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>

namespace fettle::margin {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Prior: share of the parts with waves of a given amplitude, among these and the parts without waves.
constexpr double kShare = 0.25;
constexpr double kCubicShare = 0.9;
// Amplitudes over the standard deviation of a touch. Lower waves do not matter beside the touches' error. The higher
// ones show only by touches that the fit leaves out as outliers.
constexpr std::array kAmplitudes = {4.0, 8.0, 16.0, 32.0};
constexpr std::array kLengths = {0.25, 0.5, 1.0}; // over the touches' radius, with equal probability
// Waves less probable than this change the margin by less than the scatter of the draws.
constexpr double kMinProbability = 1e-3;
// Share of the mean variance that is added to the diagonal, so that the covariance of neighbouring heights remains
// positive definite in spite of rounding.
constexpr double kJitter = 1e-6;

Eigen::Matrix3Xd inliers(const surface::Surface& surface)
{
    std::vector<Index> kept;
    for (Index i = 0; i < surface.touches.cols(); ++i)
        if (std::find(surface.outliers.begin(), surface.outliers.end(), i) == surface.outliers.end()) kept.push_back(i);
    return surface.touches(Eigen::all, kept);
}

/// The family to first order: heights at the touches and at xy by coefficients that the touches determine as well as
/// one touch determines its height. The unit is the standard deviation of a touch.
struct Trend {
    MatrixXd at_touches, at_xy;
    VectorXd residuals;
};

Trend trend_of(const surface::WeightedShape& member, const Eigen::Matrix3Xd& touches, double sigma,
               const Eigen::Matrix2Xd& xy)
{
    constexpr double kMinVariance =
        1e-6; // of a direction, relative: smaller ones are rounding, or a change that the family does not allow
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

/// Kriging with V, the covariance of the touches in the model z = F β + g + e.
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

double share_of(const surface::Shape& shape)
{
    const auto* polynomial = std::get_if<surface::Polynomial>(&shape);
    const bool is_cubic = polynomial != nullptr && polynomial->coefficients.size() > surface::monomial_count(2);
    return is_cubic ? kCubicShare : kShare;
}

/// A shape and the covariance of its parameters.
struct FittedShape {
    surface::Shape shape;
    MatrixXd covariance;
};

/// The trend of a process (fit_gaussian_process()) by itself: the quadratic of least squares.
/// @return  nothing if the touches do not determine it
std::optional<FittedShape> process_trend(const Eigen::Matrix3Xd& touches, double sigma)
{
    fit::TouchSet all;
    all.xyz = touches;
    all.sigma = sigma;
    std::optional<fit::FamilySolution> quadratic = fit::solve_family("quadratic", all, fit::all_touches(all));
    if (!quadratic) return std::nullopt;
    const core::Cholesky information(quadratic->gradients * quadratic->gradients.transpose() / (sigma * sigma));
    const Index n = quadratic->gradients.rows();
    return FittedShape{std::move(quadratic->shape), information.solve(MatrixXd::Identity(n, n))};
}

/// Touches and the family's trend at them.
struct Touches {
    Eigen::Matrix2Xd places;
    Trend trend;
    double log_prior; ///< of these touches being on good metal, and the others outliers
};

bool is_usable(const Trend& trend)
{
    return trend.at_touches.cols() < trend.at_touches.rows() && trend.at_touches.allFinite() &&
           trend.at_xy.allFinite() && trend.residuals.allFinite();
}

/// Waves of one amplitude and one length, given some touches.
struct Model {
    const Touches* touches;
    fit::Correlation correlation;
    double variance; ///< over that of a touch
    Kriging kriging;
    double probability; ///< prior, then posterior, if the part is of the family
};

double log_evidence(const Model& model) { return model.kriging.log_likelihood + model.touches->log_prior; }

/// Prior of waves of one amplitude and one length; what is left of 1 is that of no waves.
struct WavePrior {
    double amplitude; ///< over the standard deviation of a touch
    double length;    ///< mm
    double probability;
};

/// The models of the priors, each given the touches.
void add_models(const Touches& touches, const std::vector<WavePrior>& priors, std::vector<Model>& models)
{
    const MatrixXd noise = MatrixXd::Identity(touches.places.cols(), touches.places.cols());
    for (const WavePrior& prior : priors) {
        const fit::Correlation correlation{fit::Kernel::matern52, prior.length};
        const double variance = prior.amplitude * prior.amplitude;
        const MatrixXd K = fit::correlation_matrix(correlation, touches.places, touches.places);
        models.push_back(
            {&touches, correlation, variance, kriging(variance * K + noise, touches.trend), prior.probability});
    }
}

/// Sets the posterior probabilities of models that hold their prior ones.
/// @param without  prior probability of no waves, given the touches that the fit kept
void set_posterior(double without, const Touches& inliers, std::vector<Model>& models)
{
    const MatrixXd noise = MatrixXd::Identity(inliers.places.cols(), inliers.places.cols());
    const double evidence = kriging(noise, inliers.trend).log_likelihood + inliers.log_prior;
    double max = evidence;
    for (const Model& model : models) max = std::max(max, log_evidence(model));
    double sum = without * std::exp(evidence - max);
    for (Model& model : models) sum += model.probability *= std::exp(log_evidence(model) - max);
    for (Model& model : models) model.probability /= sum;
}

std::vector<WavePrior> priors_of(double amplitude, double share, const std::vector<double>& lengths)
{
    std::vector<WavePrior> priors;
    for (const double length : lengths) priors.push_back({amplitude, length, share / double(lengths.size())});
    return priors;
}

/// @param inliers  touches that the fit kept   @param all  inliers and outliers; nothing if there are no outliers
std::vector<Model> models_of_touches(double share, const Touches& inliers, const std::optional<Touches>& all,
                                     const std::vector<double>& lengths)
{
    std::vector<Model> models;
    add_models(inliers, priors_of(kAmplitudes.front(), share, lengths), models);
    if (all)
        for (const double amplitude : kAmplitudes) add_models(*all, priors_of(amplitude, share, lengths), models);
    set_posterior(1 - share, inliers, models);
    return models;
}

/// As models_of_touches(), of waves as large as those that a scan shows about the family.
std::vector<Model> models_of_scan(const std::vector<WaveSize>& sizes, double sigma, const Touches& inliers,
                                  const std::optional<Touches>& all)
{
    std::vector<WavePrior> priors;
    double without = 0;
    for (const WaveSize& size : sizes)
        if (size.amplitude == 0)
            without += size.probability;
        else if (size.probability > kMinProbability)
            priors.push_back({size.amplitude / sigma, size.length, size.probability});
    std::vector<Model> models;
    add_models(inliers, priors, models);
    if (all) add_models(*all, priors, models);
    set_posterior(without, inliers, models);
    return models;
}

Waves waves_of(const Model& model, const Eigen::Matrix2Xd& xy, double sigma)
{
    const Eigen::Matrix2Xd& places = model.touches->places;
    const Trend& trend = model.touches->trend;
    // Kriging weights of the touches' residuals in the waves at xy.
    const MatrixXd weights =
        model.variance * fit::correlation_matrix(model.correlation, xy, places) * model.kriging.inverse;
    const MatrixXd rest = trend.at_xy - weights * trend.at_touches;
    MatrixXd covariance = model.variance * fit::correlation_matrix(model.correlation, xy, xy) -
                          model.variance * weights * fit::correlation_matrix(model.correlation, places, xy) +
                          rest * model.kriging.beta * rest.transpose();
    covariance.diagonal().array() += kJitter * covariance.diagonal().mean();
    const VectorXd mean = rest * model.kriging.estimate + weights * trend.residuals;
    return {model.probability, sigma * mean, sigma * core::Cholesky(covariance).L()};
}

std::vector<Waves> waves_about_family(const surface::WeightedShape& member, const surface::Surface& surface,
                                      const Eigen::Matrix2Xd& xy, const ScanWaves* scan)
{
    const Eigen::Matrix3Xd kept = inliers(surface);
    const double sigma = surface.touch_sigma;
    if (kept.cols() == 0 || !(sigma > 0)) return {};
    const Eigen::Matrix2Xd places = kept.topRows<2>();
    const std::vector<double> lengths = wave_lengths(surface);
    const double gross = -double(surface.outliers.size()) * fit::outlier_penalty(sigma) / 2;
    const Touches inner{places, trend_of(member, kept, sigma, xy), gross};
    if (!is_usable(inner.trend) || !(lengths.front() > 0)) return {};
    std::optional<Touches> all;
    if (!surface.outliers.empty()) {
        all = Touches{surface.touches.topRows<2>(), trend_of(member, surface.touches, sigma, xy), 0};
        if (!is_usable(all->trend)) all.reset();
    }
    const double share = share_of(member.shape);
    // Where a family is not defined all over the scan, the touches speak alone.
    std::optional<std::vector<WaveSize>> sizes;
    if (scan != nullptr) {
        const MatrixXd at_scan = trend_of(member, kept, sigma, scan->places()).at_xy;
        const VectorXd residuals = scan->z() - surface::heights(member.shape, scan->places());
        if (at_scan.allFinite() && residuals.allFinite()) sizes = scan->sizes(at_scan, residuals, share);
    }
    const std::vector<Model> models =
        sizes ? models_of_scan(*sizes, sigma, inner, all) : models_of_touches(share, inner, all, lengths);
    std::vector<Waves> result;
    for (const Model& model : models)
        if (model.probability > kMinProbability) result.push_back(waves_of(model, xy, sigma));
    return result;
}

} // namespace

std::vector<double> wave_lengths(const surface::Surface& surface)
{
    const Eigen::Matrix2Xd places = inliers(surface).topRows<2>();
    if (places.cols() == 0) return {};
    const double radius = (places.colwise() - places.rowwise().mean().eval()).colwise().norm().maxCoeff();
    std::vector<double> lengths;
    for (const double length : kLengths) lengths.push_back(length * radius);
    return lengths;
}

std::vector<Waves> waves_about(const surface::WeightedShape& member, const surface::Surface& surface,
                               const Eigen::Matrix2Xd& xy, const ScanWaves* scan)
{
    if (!std::holds_alternative<surface::Bspline>(member.shape)) return waves_about_family(member, surface, xy, scan);
    if (scan == nullptr || !(surface.touch_sigma > 0)) return {};
    const std::optional<FittedShape> trend = process_trend(inliers(surface), surface.touch_sigma);
    if (!trend) return {};
    std::vector<Waves> waves = waves_about_family({member.weight, trend->shape, trend->covariance}, surface, xy, scan);
    const VectorXd offset = surface::heights(trend->shape, xy) - surface::heights(member.shape, xy);
    for (Waves& one : waves) one.offset += offset;
    return waves;
}

} // namespace fettle::margin
