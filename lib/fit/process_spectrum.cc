#include "fit/process_spectrum.h"

#include "core/decompositions.h"
#include "core/product.h"

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Correlation lengths ℓ over the touches' radius: no touches resolve shorter waves than the first, and the probe cannot
// distinguish longer ones than the last from polynomials.
constexpr std::array<double, 9> kRelativeLengths = {0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8, 4};
constexpr double kMinRatio = 0.3;
constexpr double kRatioStep = 1.6487212707001282; // factor √e

/// The largest distance from the touches' centroid: a size that does not depend on the job's rotation.
double radius_of(const Eigen::Matrix2Xd& xy)
{
    return (xy.colwise() - xy.rowwise().mean().eval()).colwise().norm().maxCoeff();
}

/// The correlation matrix of some places, by one half of it: the other is the same.
MatrixXd symmetric_correlation(const Correlation& correlation, const MatrixXd& squared)
{
    const Index n = squared.rows();
    Eigen::ArrayXd half(n * (n + 1) / 2);
    for (Index j = 0, k = 0; j < n; k += n - j, ++j) half.segment(k, n - j) = squared.col(j).tail(n - j).array();
    half = correlation_at(correlation, half);
    MatrixXd result(n, n);
    for (Index j = 0, k = 0; j < n; k += n - j, ++j) {
        result.col(j).tail(n - j) = half.segment(k, n - j).matrix();
        result.row(j).tail(n - j) = half.segment(k, n - j).matrix().transpose();
    }
    return result;
}

/// Σ ln of numbers in (0, 1], by few logarithms.
double log_of_product(const VectorXd& factors)
{
    constexpr double kMinProduct = 1e-150; // times another such number, the product is still no denormal one
    double sum = 0, product = 1;
    for (const double factor : factors) {
        product *= factor;
        if (product > kMinProduct) continue;
        sum += std::log(product);
        product = 1;
    }
    return sum + std::log(product);
}

} // namespace

ProcessTouches subset_of(const ProcessTouches& all, const TouchIndices& kept)
{
    return {all.xy(Eigen::all, kept), all.z(kept), all.sigma, all.F(kept, Eigen::all)};
}

double amplitude_ratio(int i) { return kMinRatio * std::pow(kRatioStep, i); }

void set_scores(Spectrum& s, double factor, Index trend)
{
    const double trend_penalty = trend * std::log(s.E.rows());
    const Eigen::ArrayXd squares = (s.y / factor).array().square();
    for (int i = 0; i < kNumRatios; ++i) {
        const VectorXd d = precision(s, amplitude_ratio(i));
        s.score[i] = trend_penalty - log_of_product(d) + (squares * d.array()).sum();
    }
}

VectorXd precision(const Spectrum& s, double ratio) { return (1 + ratio * ratio * s.lambda.array()).inverse(); }

std::vector<Spectrum> compute_spectra(const ProcessTouches& touches)
{
    const double radius = radius_of(touches.xy);
    const Index n = touches.F.rows(), p = touches.F.cols();
    const MatrixXd Q = core::householder_qr(touches.F, n).Q;
    const MatrixXd rest = Q.rightCols(n - p), rest_transposed = rest.transpose();
    const MatrixXd squared = squared_distances(touches.xy, touches.xy);
    constexpr std::size_t kLengths = kRelativeLengths.size();
    std::vector<Spectrum> all(2 * kLengths);
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
        Spectrum& s = all[k];
        s.correlation = {k < kLengths ? Kernel::squared_exponential : Kernel::matern52,
                         kRelativeLengths[k % kLengths] * radius};
        const MatrixXd K = symmetric_correlation(s.correlation, squared);
        const core::SymmetricEigen<Eigen::Dynamic> eigen =
            core::symmetric_eigen<Eigen::Dynamic>(core::product(core::product(rest_transposed, K), rest));
        s.E = core::product(rest, eigen.vectors);
        s.lambda = eigen.values.cwiseMax(0);
        s.y = s.E.transpose() * touches.z / touches.sigma;
        set_scores(s, 1, p);
    });
    return all;
}

double min_score(const std::vector<Spectrum>& all)
{
    double result = std::numeric_limits<double>::infinity();
    for (const Spectrum& s : all) result = std::min(result, *std::min_element(s.score.begin(), s.score.end()));
    return result;
}

} // namespace fettle::fit
