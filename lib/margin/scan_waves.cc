#include "margin/scan_waves.h"

#include "core/cholesky.h"
#include "core/error.h"
#include "fit/correlation.h"
#include "geometry/bounding_box.h"
#include "geometry/quantiles.h"
#include "job/boundary.h"
#include "surface/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace fettle::margin {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Heights around B: enough to tell waves of a quarter of the touches' radius from noise, and few enough that their
// correlation matrix is decomposed in a tenth of a second.
constexpr double kScanPlaces = 300;
constexpr Index kMinScanPlaces = 40;
constexpr double kMaxSpikeSigmas = 6; // of a height from a cubic through all of them; a spike, or not the metal

// Amplitudes and the noise's standard deviations over the root mean square of the residuals about the trend, in steps
// finer than the data can tell apart. Long waves are higher than what they leave about a trend.
constexpr std::array kAmplitudeSteps = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::array kNoiseSteps = {0.03125, 0.0625, 0.125, 0.25, 0.5, 1.0};

/// Leaves out heights that are far from a cubic through the others.
Eigen::Matrix3Xd without_spikes(Eigen::Matrix3Xd heights)
{
    constexpr int kDegree = 3, kMaxRounds = 5;
    for (int round = 0; round < kMaxRounds; ++round) {
        const Eigen::Matrix2Xd at = heights.topRows<2>();
        surface::Polynomial cubic;
        cubic.origin = at.rowwise().mean();
        cubic.scale = (at.colwise() - cubic.origin).cwiseAbs().maxCoeff();
        cubic.coefficients.setZero(surface::monomial_count(kDegree));
        const MatrixXd monomials = surface::height_gradients(cubic, at).transpose();
        const VectorXd z = heights.row(2).transpose();
        const VectorXd off = z - monomials * core::least_squares_by_qr(monomials, z).x;
        const double limit = kMaxSpikeSigmas * geometry::kMedianToSigma * geometry::median_absolute(off);
        std::vector<Index> kept;
        for (Index i = 0; i < off.size(); ++i)
            if (std::abs(off[i]) <= limit) kept.push_back(i);
        const bool is_all = static_cast<Index>(kept.size()) == off.size();
        if (is_all || static_cast<Index>(kept.size()) < kMinScanPlaces) break;
        heights = Eigen::Matrix3Xd(heights(Eigen::all, kept));
    }
    return heights;
}

/// Parts of a likelihood that are the same for all sizes of one correlation: F and the residuals along its
/// eigenvectors.
struct Rotated {
    MatrixXd F;
    VectorXd r;
};

/// ln of the restricted likelihood of residuals with independent variances v, without its constant
double log_restricted_likelihood(const Rotated& data, const VectorXd& v)
{
    const VectorXd weight = v.cwiseInverse();
    const core::Cholesky information(data.F.transpose() * weight.asDiagonal() * data.F);
    const VectorXd weighted = weight.cwiseProduct(data.r), sums = data.F.transpose() * weighted;
    return -v.array().log().sum() / 2 - information.L().diagonal().array().log().sum() -
           (data.r.dot(weighted) - sums.dot(information.solve(sums))) / 2;
}

} // namespace

Eigen::Matrix3Xd heights_around_anomaly(const sampling::Scan& scan, const job::Job& job, const std::string& source)
{
    const job::Boundaries region = job::working_boundaries(job);
    const Eigen::AlignedBox2d box = geometry::bounding_box(region.sampling);
    const double step =
        std::sqrt((job::area(job::convex_hull(region.sampling)) - job::area(region.anomaly)) / kScanPlaces);
    const Eigen::Matrix2d machine = job::rotation_working_machine(job.theta).transpose();
    std::vector<Eigen::Vector3d> heights;
    for (double y = box.min().y() + step / 2; y < box.max().y(); y += step)
        for (double x = box.min().x() + step / 2; x < box.max().x(); x += step) {
            const Eigen::Vector2d working(x, y), xy = machine * working;
            if (!job::contains(region.sampling, working) || job::contains(region.anomaly, working)) continue;
            if (const std::optional<double> z = scan.height(xy)) heights.emplace_back(xy.x(), xy.y(), *z);
        }
    Eigen::Matrix3Xd all = job::columns_to_matrix(heights);
    if (all.cols() >= kMinScanPlaces) all = without_spikes(std::move(all));
    if (all.cols() < kMinScanPlaces)
        throw core::InputError(source, "shows the metal around the anomaly at " + std::to_string(all.cols()) + " of " +
                                           std::to_string(static_cast<int>(kScanPlaces)) + " places; its waves need " +
                                           std::to_string(kMinScanPlaces));
    return all;
}

ScanWaves::ScanWaves(const Eigen::Matrix3Xd& heights, const std::vector<double>& lengths)
    : heights_(heights), lengths_(lengths)
{
    const Eigen::Matrix2Xd at = places();
    for (const double length : lengths)
        correlations_.push_back(
            core::symmetric_eigen<Eigen::Dynamic>(fit::correlation_matrix({fit::Kernel::matern52, length}, at, at)));
}

std::vector<WaveSize> ScanWaves::sizes(const MatrixXd& trend, const VectorXd& residuals, double share) const
{
    const VectorXd about = residuals - trend * core::least_squares_by_qr(trend, residuals).x;
    const double rms = std::sqrt(about.squaredNorm() / static_cast<double>(about.size() - trend.cols()));
    std::vector<WaveSize> all; // log likelihoods first
    const auto add = [&](double amplitude, std::size_t k, const Rotated& data, double prior) {
        const VectorXd waves = amplitude * amplitude * correlations_[k].values.cwiseMax(0);
        std::array<double, kNoiseSteps.size()> logs{};
        for (std::size_t n = 0; n < kNoiseSteps.size(); ++n)
            logs[n] = log_restricted_likelihood(data, (waves.array() + kNoiseSteps[n] * kNoiseSteps[n]).matrix());
        const double max = *std::max_element(logs.begin(), logs.end());
        double sum = 0;
        for (const double log : logs) sum += std::exp(log - max);
        all.push_back({amplitude * rms, lengths_[k], max + std::log(sum * prior)});
    };
    if (!(rms > 0)) return {{0, lengths_.front(), 1}};
    for (std::size_t k = 0; k < lengths_.size(); ++k) {
        const MatrixXd turn = correlations_[k].vectors.transpose();
        const Rotated data{turn * trend, turn * residuals / rms};
        if (k == 0) add(0, k, data, 1 - share);
        for (const double amplitude : kAmplitudeSteps)
            add(amplitude, k, data, share / static_cast<double>(kAmplitudeSteps.size() * lengths_.size()));
    }
    double max = all.front().probability, sum = 0;
    for (const WaveSize& one : all) max = std::max(max, one.probability);
    for (WaveSize& one : all) sum += one.probability = std::exp(one.probability - max);
    for (WaveSize& one : all) one.probability /= sum;
    return all;
}

} // namespace fettle::margin
