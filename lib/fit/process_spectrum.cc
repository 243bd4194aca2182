#include "fit/process_spectrum.h"

#include "core/decompositions.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ℓ over half the touched size: shorter waves than the first are beyond the spacing of any touches, longer ones than
// the last are polynomials to the probe.
constexpr std::array<double, 9> kLengths = {0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8, 4};
constexpr double kLeastRatio = 0.3;
constexpr double kRatioStep = 1.6487212707001282; // half a unit of ln

/// Half the touched size, however it is turned.
double half_size(const Eigen::Matrix2Xd& xy)
{
    return (xy.colwise() - xy.rowwise().mean().eval()).colwise().norm().maxCoeff();
}

} // namespace

ProcessTouches part_of(const ProcessTouches& all, const Columns& kept)
{
    return {all.xy(Eigen::all, kept), all.z(kept), all.sigma, all.F(kept, Eigen::all)};
}

double ratio_of(int i) { return kLeastRatio * std::pow(kRatioStep, i); }

VectorXd precision(const Spectrum& s, double ratio) { return (1 + ratio * ratio * s.lambda.array()).inverse(); }

std::vector<Spectrum> spectra(const ProcessTouches& touches)
{
    std::vector<Spectrum> all;
    const double half = half_size(touches.xy);
    const Index n = touches.F.rows(), p = touches.F.cols();
    const double price = static_cast<double>(p) * std::log(static_cast<double>(n));
    const MatrixXd Q = orthogonal(touches.F, n).Q;
    const MatrixXd rest = Q.rightCols(n - p);
    for (const Roughness roughness : {Roughness::none, Roughness::matern})
        for (const double length : kLengths) {
            Spectrum s;
            s.correlation = {roughness, length * half};
            const MatrixXd K = correlations(s.correlation, touches.xy, touches.xy);
            const SymmetricEigen<Eigen::Dynamic> eigen = symmetric_eigen<Eigen::Dynamic>(rest.transpose() * K * rest);
            s.E = rest * eigen.vectors;
            s.lambda = eigen.values.cwiseMax(0);
            s.y = s.E.transpose() * touches.z / touches.sigma;
            for (int i = 0; i < kRatios; ++i) {
                const Eigen::ArrayXd d = precision(s, ratio_of(i));
                s.score[static_cast<std::size_t>(i)] = price - d.log().sum() + (s.y.array().square() * d).sum();
            }
            all.push_back(std::move(s));
        }
    return all;
}

double best_score(const std::vector<Spectrum>& all)
{
    double best = std::numeric_limits<double>::infinity();
    for (const Spectrum& s : all) best = std::min(best, *std::min_element(s.score.begin(), s.score.end()));
    return best;
}

} // namespace fettle
