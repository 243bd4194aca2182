#include "fit/process.h"

#include "fit/bspline.h"
#include "fit/leave_one_out.h"
#include "fit/process_mixture.h"
#include "fit/process_spectrum.h"
#include "fit/process_weights.h"
#include "surface/shapes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// With P = E (σ² + τ² λ)⁻¹ Eᵀ, touch i deviates from the prediction of the others by (P z)_i / P_ii, of variance
/// 1 / P_ii (Wahba 1990, 4.2). In units of σ.
LeaveOneOut leave_one_out(const std::vector<Spectrum>& all)
{
    const Index n = all.front().E.rows(), models = static_cast<Index>(all.size()) * kNumRatios;
    LeaveOneOut result{Eigen::MatrixXd(n, models), Eigen::MatrixXd(n, models), Eigen::MatrixXd(n, models)};
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
        const Spectrum& s = all[k];
        Eigen::MatrixXd d(s.lambda.size(), kNumRatios);
        for (int i = 0; i < kNumRatios; ++i) d.col(i) = precision(s, amplitude_ratio(i));
        const Eigen::ArrayXXd P = (s.E.cwiseAbs2() * d).array(), Pz = (s.E * (s.y.asDiagonal() * d)).array();
        const auto columns = Eigen::seqN(static_cast<Index>(k) * kNumRatios, Eigen::fix<kNumRatios>);
        result.deviation(Eigen::all, columns) = (Pz / P).matrix();
        result.variance(Eigen::all, columns) = P.inverse().matrix();
        result.log_weight(Eigen::all, columns) = ((Pz.square() / P - P.log()) / 2).matrix();
        for (int i = 0; i < kNumRatios; ++i)
            result.log_weight.col(static_cast<Index>(k) * kNumRatios + i).array() -= s.score[i] / 2;
    });
    return result;
}

Index worst_outlier(const std::vector<Spectrum>& all, double sigma)
{
    // The penalty leaves out the constant of the normal density.
    const double log_outlier = -(outlier_penalty(sigma) + std::log(2 * std::numbers::pi)) / 2;
    return most_probable_outlier(leave_one_out(all), log_outlier);
}

/// Removes outliers from `touches` one by one, up to `max_outliers`. `spectra` becomes that of the inliers.
/// @return  indices of the outliers among the original touches
TouchIndices reject_outliers(ProcessTouches& touches, std::vector<Spectrum>& spectra, std::size_t max_outliers)
{
    const ProcessTouches all = touches;
    TouchIndices kept(all.z.size()), outliers;
    std::iota(kept.begin(), kept.end(), Index{0});
    for (spectra = compute_spectra(touches); outliers.size() < max_outliers; spectra = compute_spectra(touches)) {
        const Index worst = worst_outlier(spectra, all.sigma);
        if (worst < 0) break;
        outliers.push_back(kept[worst]);
        kept.erase(kept.begin() + worst);
        touches = subset_of(all, kept);
    }
    std::sort(outliers.begin(), outliers.end());
    return outliers;
}

} // namespace

std::optional<FitCandidate> fit_gaussian_process(const TouchSet& touches, const surface::Bspline& grid)
{
    std::optional<FamilySolution> trend = solve_family("quadratic", touches, all_touches(touches));
    if (!trend) trend = solve_family("plane", touches, all_touches(touches));
    constexpr Index kMinRedundancy = 2;
    const Index n = touches.xyz.cols();
    if (!trend || n < trend->gradients.rows() + kMinRedundancy) return std::nullopt;
    const Index p = trend->gradients.rows();

    ProcessTouches inliers{touches.xyz.topRows(2), touches.xyz.row(2).transpose(), touches.sigma,
                           trend->gradients.transpose()};
    FitCandidate candidate;
    candidate.method = "gp";
    std::vector<Spectrum> spectra;
    candidate.outliers = reject_outliers(inliers, spectra, std::min(n - p - kMinRedundancy, n / 4));
    const ProcessWeights weights = mixture_weights(spectra);
    candidate.score = min_score(spectra) - 2 * std::log(weights.sum / (spectra.size() * kNumRatios)) +
                      outlier_penalty(touches.sigma) * candidate.outliers.size();
    candidate.freedom = inliers.z.size() - p;

    // The mixture of all correlations and amplitudes, on a grid as coarse as they allow.
    surface::Bspline spline = coarsen(grid, weights.cell);
    const ControlHeights controls(spline);
    const Eigen::MatrixXd trend_controls =
        controls.from_values(surface::height_gradients(trend->shape, controls.nodes()).transpose());
    VectorXd heights;
    std::tie(heights, candidate.covariance) =
        mix_processes(inliers, controls, trend_controls, spectra, weights.relative);
    spline.heights = heights.reshaped(spline.heights.rows(), spline.heights.cols());
    candidate.shape = std::move(spline);
    return candidate;
}

} // namespace fettle::fit
