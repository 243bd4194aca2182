#include "fit/process.h"

#include "fit/process_mixture.h"
#include "fit/process_spectrum.h"
#include "surface/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// The longest cell on which a correlation is followed: the quasi-interpolant's error falls with its fourth power where
/// the process is smooth without end.
double longest_cell(const Correlation& correlation)
{
    return correlation.length / (correlation.roughness == Roughness::none ? 2 : 3);
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

} // namespace

std::optional<Candidate> fit_process(const Touched& touched, const Bspline& grid)
{
    std::optional<FamilySolution> trend = solve_family("quadratic", touched, all_touches(touched));
    if (!trend) trend = solve_family("plane", touched, all_touches(touched));
    constexpr Index kRest = 2; // touches that nothing has taken up yet
    if (!trend || touched.xyz.cols() < trend->gradients.rows() + kRest) return std::nullopt;
    const ProcessTouches all{touched.xyz.topRows(2), touched.xyz.row(2).transpose(), touched.sigma,
                             trend->gradients.transpose()};

    Columns kept = all_touches(touched);
    ProcessTouches some = all;
    const auto most_slips =
        static_cast<std::size_t>(std::min(touched.xyz.cols() - all.F.cols() - kRest, touched.xyz.cols() / 4));
    Candidate candidate;
    candidate.method = "gp";
    std::vector<Spectrum> believed = spectra(some);
    while (candidate.gross_errors.size() < most_slips) {
        const Index worst = worst_slip(believed, touched.sigma);
        if (worst < 0) break;
        candidate.gross_errors.push_back(kept[static_cast<std::size_t>(worst)]);
        kept.erase(kept.begin() + worst);
        some = part_of(all, kept);
        believed = spectra(some);
    }
    std::sort(candidate.gross_errors.begin(), candidate.gross_errors.end());

    constexpr double kLeastWeight = 0.01; // of the most probable one
    constexpr double kLeastShare = 0.01; // of the process as a whole, for a correlation to be followed
    const double best = best_score(believed);
    std::vector<std::array<double, kRatios>> weights(believed.size());
    VectorXd shares = VectorXd::Zero(static_cast<Index>(believed.size()));
    for (std::size_t k = 0; k < believed.size(); ++k)
        for (std::size_t i = 0; i < kRatios; ++i) {
            const double weight = std::exp((best - believed[k].score[i]) / 2);
            shares[static_cast<Index>(k)] += weight;
            weights[k][i] = weight < kLeastWeight ? 0 : weight;
        }
    const double sum = shares.sum();
    double longest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < believed.size(); ++k)
        if (shares[static_cast<Index>(k)] >= kLeastShare * sum)
            longest = std::min(longest, longest_cell(believed[k].correlation));
    candidate.score = best - 2 * std::log(sum / static_cast<double>(believed.size() * kRatios)) +
                      price_of_a_slip(touched.sigma) * static_cast<double>(candidate.gross_errors.size());
    candidate.freedom = static_cast<double>(kept.size()) - static_cast<double>(all.F.cols());

    // Their mean by probability.
    Bspline spline = coarsened(grid, longest);
    const ControlHeights controls(spline);
    const Eigen::MatrixXd trend_controls = controls.from(height_gradients(trend->shape, controls.nodes()).transpose());
    ProcessMixture mixture(some, controls, trend_controls);
    for (std::size_t k = 0; k < believed.size(); ++k) mixture.add(believed[k], weights[k]);
    VectorXd heights;
    std::tie(heights, candidate.covariance) = mixture.result();
    spline.heights = heights.reshaped(spline.heights.rows(), spline.heights.cols());
    candidate.shape = std::move(spline);
    return candidate;
}

} // namespace fettle
