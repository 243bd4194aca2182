#include "fit/process.h"

#include "fit/process_mixture.h"
#include "fit/process_spectrum.h"
#include "surface/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

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

/// The longest cell on which a process is followed: where it is smooth without end, the quasi-interpolant's error is
/// 0.08 τ (h/ℓ)⁴ (rms), a tenth of σ. Matérn's of 5/2 is rougher than touches can tell within a cell: 0.38 τ
/// (h/ℓ)^(5/2), 0.4 σ.
double longest_cell(const Correlation& correlation, double ratio)
{
    return correlation.length *
           (correlation.roughness == Roughness::none ? std::pow(ratio / 1.2, -0.25) : std::pow(ratio, -0.4));
}

/// The same rectangle in cells up to `longest` mm, no finer than they were.
Bspline coarsened(const Bspline& grid, double longest)
{
    constexpr Index kMore = 3; // functions than cells: cubic
    constexpr double kFewest = 4;
    const Eigen::Array2d before(static_cast<double>(grid.heights.rows() - kMore),
                                static_cast<double>(grid.heights.cols() - kMore));
    const Eigen::Array2d side = before * grid.cell.array();
    const Eigen::Array2d after = (side / longest).ceil().max(kFewest).min(before);
    Bspline result = grid;
    result.cell = side / after;
    result.heights.setZero(static_cast<Index>(after.x()) + kMore, static_cast<Index>(after.y()) + kMore);
    return result;
}

/// Takes out of `touches` what is better explained as a slip than by the others, one by one, up to `most`.
/// @return  which of all; `believed` are the spectra of the others
Columns take_slips(ProcessTouches& touches, std::vector<Spectrum>& believed, std::size_t most)
{
    const ProcessTouches all = touches;
    Columns kept(static_cast<std::size_t>(all.z.size())), slips;
    std::iota(kept.begin(), kept.end(), Index{0});
    for (believed = spectra(touches); slips.size() < most; believed = spectra(touches)) {
        const Index worst = worst_slip(believed, all.sigma);
        if (worst < 0) break;
        slips.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        touches = part_of(all, kept);
    }
    std::sort(slips.begin(), slips.end());
    return slips;
}

/// How probable the correlations and amplitudes are, against the most probable one of all.
struct Weights {
    std::vector<std::array<double, kRatios>> of; ///< 0 where they change nothing that shows
    double sum = 0;
    double cell = 0; ///< mm, on which all correlations are followed that matter
};

Weights weights_of(const std::vector<Spectrum>& believed)
{
    constexpr double kLeastWeight = 0.01;
    constexpr double kLeastShare = 0.01; // of the sum, for a correlation to matter
    const double best = best_score(believed);
    Weights weights{std::vector<std::array<double, kRatios>>(believed.size()), 0,
                    std::numeric_limits<double>::infinity()};
    std::vector<double> shares(believed.size(), 0);
    for (std::size_t k = 0; k < believed.size(); ++k)
        for (std::size_t i = 0; i < kRatios; ++i) {
            const double weight = std::exp((best - believed[k].score[i]) / 2);
            shares[k] += weight;
            weights.of[k][i] = weight < kLeastWeight ? 0 : weight;
        }
    weights.sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (std::size_t k = 0; k < believed.size(); ++k)
        for (int i = 0; i < kRatios; ++i)
            if (shares[k] >= kLeastShare * weights.sum && weights.of[k][static_cast<std::size_t>(i)] > 0)
                weights.cell = std::min(weights.cell, longest_cell(believed[k].correlation, ratio_of(i)));
    return weights;
}

} // namespace

std::optional<Candidate> fit_process(const Touched& touched, const Bspline& grid)
{
    std::optional<FamilySolution> trend = solve_family("quadratic", touched, all_touches(touched));
    if (!trend) trend = solve_family("plane", touched, all_touches(touched));
    constexpr Index kRest = 2; // touches that nothing has taken up yet
    const Index n = touched.xyz.cols();
    if (!trend || n < trend->gradients.rows() + kRest) return std::nullopt;
    const Index p = trend->gradients.rows();

    ProcessTouches touches{touched.xyz.topRows(2), touched.xyz.row(2).transpose(), touched.sigma,
                           trend->gradients.transpose()};
    Candidate candidate;
    candidate.method = "gp";
    std::vector<Spectrum> believed;
    candidate.gross_errors = take_slips(touches, believed, static_cast<std::size_t>(std::min(n - p - kRest, n / 4)));
    const Weights weights = weights_of(believed);
    candidate.score = best_score(believed) -
                      2 * std::log(weights.sum / static_cast<double>(believed.size() * kRatios)) +
                      price_of_a_slip(touched.sigma) * static_cast<double>(candidate.gross_errors.size());
    candidate.freedom = static_cast<double>(touches.z.size() - p);

    // Their mean by probability.
    Bspline spline = coarsened(grid, weights.cell);
    const ControlHeights controls(spline);
    const Eigen::MatrixXd trend_controls = controls.from(height_gradients(trend->shape, controls.nodes()).transpose());
    ProcessMixture mixture(touches, controls, trend_controls);
    for (std::size_t k = 0; k < believed.size(); ++k) mixture.add(believed[k], weights.of[k]);
    VectorXd heights;
    std::tie(heights, candidate.covariance) = mixture.result();
    spline.heights = heights.reshaped(spline.heights.rows(), spline.heights.cols());
    candidate.shape = std::move(spline);
    return candidate;
}

} // namespace fettle
