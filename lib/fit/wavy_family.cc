#include "fit/wavy_family.h"

#include "core/cholesky.h"
#include "fit/process_mixture.h"
#include "fit/process_spectrum.h"
#include "fit/process_weights.h"
#include "surface/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMaxCoarsening = 1.5; // of the cells, however long the waves

/// ∂z/∂θ along the allowed changes of θ, a column each.
MatrixXd allowed_gradients(const FamilySolution& family, const MatrixXd& gradients)
{
    const MatrixXd& free = family.free_directions;
    return free.size() > 0 ? MatrixXd((free.transpose() * gradients).transpose()) : MatrixXd(gradients.transpose());
}

/// The heights above the family, with its gradients as the trend.
ProcessTouches about_family(const TouchSet& touches, const FamilySolution& family)
{
    const Eigen::Matrix2Xd xy = touches.xyz.topRows<2>();
    return {xy, touches.xyz.row(2).transpose() - surface::heights(family.shape, xy), touches.sigma,
            allowed_gradients(family, family.gradients)};
}

/// The waves that are shorter than half of B.
struct ShortWaves {
    double probability = 0; ///< that the heights' waves are
    MatrixXd covariance;    ///< Σ τ² K of the heights, if they are, mm²
};

ShortWaves short_waves(const std::vector<Spectrum>& spectra, const ProcessTouches& touches, double anomaly_size)
{
    const double shortest = spectra.front().correlation.length; // counts even beside a small B
    const double max_length = std::max(anomaly_size / 2, shortest);
    const double best = min_score(spectra);
    double best_short = std::numeric_limits<double>::infinity(), all = 0;
    std::vector<const Spectrum*> shorter;
    for (const Spectrum& s : spectra) {
        for (const double score : s.score) all += std::exp((best - score) / 2);
        if (s.correlation.length > max_length) continue;
        shorter.push_back(&s);
        best_short = std::min(best_short, *std::min_element(s.score.begin(), s.score.end()));
    }
    ShortWaves waves{0, MatrixXd::Zero(touches.z.size(), touches.z.size())};
    double sum = 0;
    for (const Spectrum* s : shorter) {
        double tau2 = 0;
        for (int i = 0; i < kNumRatios; ++i) {
            const double weight = std::exp((best_short - s->score[i]) / 2);
            tau2 += weight * std::pow(amplitude_ratio(i) * touches.sigma, 2);
            sum += weight;
        }
        waves.covariance += tau2 * correlation_matrix(s->correlation, touches.xy, touches.xy);
    }
    waves.covariance /= sum;
    waves.probability = sum * std::exp((best - best_short) / 2) / all;
    return waves;
}

/// Covariance of θ by least squares if the heights deviate by waves and noise.
MatrixXd covariance_of_family(const ProcessTouches& touches, const MatrixXd& waves)
{
    const MatrixXd from_heights = core::solve_ldlt(touches.F.transpose() * touches.F, touches.F.transpose());
    MatrixXd heights = waves;
    heights.diagonal().array() += touches.sigma * touches.sigma;
    return from_heights * heights * from_heights.transpose();
}

/// f + g as a spline; nothing where f is not defined around the grid, or where it has parameters that no height depends
/// on, as the cone and the torus nearest to a plane.
std::optional<FitCandidate> spline_with_waves(const FamilySolution& family, const ProcessTouches& touches,
                                              const std::vector<Spectrum>& spectra, const ProcessWeights& weights,
                                              const surface::Bspline& grid)
{
    surface::Bspline spline = grid;
    const ControlHeights controls(spline);
    const MatrixXd gradients = surface::height_gradients(family.shape, controls.nodes());
    const VectorXd heights = surface::heights(family.shape, controls.nodes());
    if (!gradients.allFinite() || !heights.allFinite()) return std::nullopt;
    const MatrixXd trend = controls.from_values(allowed_gradients(family, gradients));
    FitCandidate candidate;
    VectorXd above;
    std::tie(above, candidate.covariance) = mix_processes(touches, controls, trend, spectra, weights.relative);
    if (!above.allFinite() || !candidate.covariance.allFinite()) return std::nullopt;
    const VectorXd sum = controls.from_values(heights) + above;
    spline.heights = sum.reshaped(spline.heights.rows(), spline.heights.cols());
    candidate.shape = std::move(spline);
    return candidate;
}

/// −2 ln of the likelihood of all processes together.
double integrated_score(const std::vector<Spectrum>& spectra)
{
    const double best = min_score(spectra);
    double sum = 0;
    for (const Spectrum& s : spectra)
        for (const double score : s.score) sum += std::exp((best - score) / 2);
    return best - 2 * std::log(sum / (spectra.size() * kNumRatios));
}

} // namespace

double noise_about_process(const TouchSet& touches)
{
    constexpr int kMaxSteps = 16; // to 256 times the noise
    constexpr double kStep = 1.4142135623730951;
    const std::optional<FamilySolution> quadratic = solve_family("quadratic", touches, all_touches(touches));
    if (!quadratic) return touches.sigma;
    const std::vector<Spectrum> spectra = compute_spectra(about_family(touches, *quadratic));
    const double redundant = touches.xyz.cols() - quadratic->gradients.rows();
    double best = touches.sigma, min_score = std::numeric_limits<double>::infinity(), factor = 1;
    for (int step = 0; step <= kMaxSteps; ++step, factor *= kStep) {
        std::vector<Spectrum> scaled = spectra;
        for (Spectrum& s : scaled) set_scores(s, factor, quadratic->gradients.rows());
        const double score = integrated_score(scaled) + 2 * redundant * std::log(factor);
        if (!(score < min_score)) continue;
        min_score = score;
        best = factor * touches.sigma;
    }
    return best;
}

std::optional<WavyFamily> fit_wavy_family(const std::string& name, const TouchSet& touches,
                                          const surface::Bspline& grid, double anomaly_size)
{
    const std::optional<FamilySolution> family = solve_family(name, touches, all_touches(touches));
    if (!family || !family->converged || !family->gradients.allFinite()) return std::nullopt;
    const ProcessTouches about = about_family(touches, *family);
    const Index p = about.F.cols(), n = about.F.rows();
    if (n <= p) return std::nullopt;
    const std::vector<Spectrum> spectra = compute_spectra(about);
    const ProcessWeights weights = mixture_weights(spectra);
    // The coefficients of the spline come from three cells beyond its rectangle, where a family may end.
    const double max_cell = std::min(weights.cell, kMaxCoarsening * grid.cell.maxCoeff());
    std::optional<FitCandidate> spline = spline_with_waves(*family, about, spectra, weights, coarsen(grid, max_cell));
    if (!spline) spline = spline_with_waves(*family, about, spectra, weights, grid);
    const ShortWaves waves = short_waves(spectra, about, anomaly_size);

    WavyFamily result;
    FitCandidate& alone = result.without_waves;
    alone.method = name;
    alone.shape = family->shape;
    alone.covariance = covariance_of_family(about, waves.covariance);
    const MatrixXd& free = family->free_directions;
    if (free.size() > 0) alone.covariance = free * alone.covariance * free.transpose();
    alone.score = integrated_score(spectra);
    alone.freedom = n - p;
    alone.iterations = family->iterations;
    result.with_waves = alone;
    result.scanner_probability = spline ? waves.probability / 2 : 1;
    if (!spline) return result;
    result.with_waves.method = name + "+gp";
    result.with_waves.shape = std::move(spline->shape);
    result.with_waves.covariance = std::move(spline->covariance);
    return result;
}

} // namespace fettle::fit
