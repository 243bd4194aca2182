#include "fit/process_mixture.h"

#include "core/decompositions.h"
#include "core/product.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// The spline's prefilter 1 / (1 - 2/3 s), s = sin²(ω/2), as 1 + 2/3 s + 4/9 s².
constexpr std::array<double, 5> kPrefilter = {1 / 36.0, -10 / 36.0, 54 / 36.0, -10 / 36.0, 1 / 36.0};
constexpr Index kExtraNodes = 2; // beyond each end

/// Control heights along one axis from the values at its nodes, each of them a row.
template <typename Values>
auto filtered_rows(const Values& values, Index count)
{
    const auto& w = kPrefilter;
    return w[0] * values.middleRows(0, count) + w[1] * values.middleRows(1, count) +
           w[2] * values.middleRows(2, count) + w[3] * values.middleRows(3, count) + w[4] * values.middleRows(4, count);
}

/// Control heights along the other axis, where the values at a node are a column.
template <typename Values>
auto filtered_columns(const Values& values, Index count)
{
    const auto& w = kPrefilter;
    return w[0] * values.middleCols(0, count) + w[1] * values.middleCols(1, count) +
           w[2] * values.middleCols(2, count) + w[3] * values.middleCols(3, count) + w[4] * values.middleCols(4, count);
}

} // namespace

ControlHeights::ControlHeights(const surface::Bspline& grid)
    : rows_(grid.heights.rows()), columns_(grid.heights.cols()), cell_(grid.cell), origin_(grid.origin),
      angle_(grid.angle), nodes_(2, (rows_ + 2 * kExtraNodes) * (columns_ + 2 * kExtraNodes))
{
    const Eigen::Rotation2Dd turn(grid.angle);
    for (Index j = 0; j < columns_ + 2 * kExtraNodes; ++j)
        for (Index i = 0; i < rows_ + 2 * kExtraNodes; ++i)
            nodes_.col(j * (rows_ + 2 * kExtraNodes) + i) =
                grid.origin + turn * cell_.cwiseProduct(Vector2d(i - kExtraNodes - 1, j - kExtraNodes - 1));
}

MatrixXd ControlHeights::from_values(const MatrixXd& values) const
{
    MatrixXd result(size(), values.cols()), along(rows_, columns_ + 2 * kExtraNodes);
    for (Index k = 0; k < values.cols(); ++k) {
        along = filtered_rows(values.col(k).reshaped(rows_ + 2 * kExtraNodes, columns_ + 2 * kExtraNodes), rows_);
        result.col(k).reshaped(rows_, columns_) = filtered_columns(along, columns_);
    }
    return result;
}

// exp(-(u² + v²) / 2) is a product: of a squared exponential each axis of the grid is filtered alone.
MatrixXd ControlHeights::correlation_with(const Correlation& correlation, const Eigen::Matrix2Xd& points,
                                          const MatrixXd& squared) const
{
    if (correlation.kernel != Kernel::squared_exponential) return from_values(correlation_matrix(correlation, squared));
    const Eigen::Matrix2Xd in_grid = Eigen::Rotation2Dd(-angle_).toRotationMatrix() * (points.colwise() - origin_);
    const auto filtered_axis = [&](Index axis, Index count) -> MatrixXd {
        const Index nodes = count + 2 * kExtraNodes;
        const VectorXd places = cell_[axis] * VectorXd::LinSpaced(nodes, -kExtraNodes - 1, nodes - kExtraNodes - 2);
        const MatrixXd offsets = places.replicate(1, points.cols()).rowwise() - in_grid.row(axis);
        return filtered_rows(correlation_matrix(correlation, MatrixXd(offsets.cwiseAbs2())), count);
    };
    const MatrixXd rows = filtered_axis(0, rows_), columns = filtered_axis(1, columns_);
    MatrixXd result(size(), points.cols());
    for (Index k = 0; k < points.cols(); ++k)
        result.col(k).reshaped(rows_, columns_).noalias() = rows.col(k) * columns.col(k).transpose();
    return result;
}

// Σ w_p w_q (correlation of nodes p rows and q columns farther), w the interpolant's weights convolved with themselves.
MatrixXd ControlHeights::correlation_by_offset(const Correlation& correlation) const
{
    constexpr Index kHalfLength = 2 * kExtraNodes;
    std::array<double, 2 * kHalfLength + 1> convolved{};
    for (std::size_t p = 0; p < kPrefilter.size(); ++p)
        for (std::size_t q = 0; q < kPrefilter.size(); ++q) convolved[p + q] += kPrefilter[p] * kPrefilter[q];
    const Index rows = rows_ + kHalfLength, columns = columns_ + kHalfLength;
    const Eigen::ArrayXd u = Eigen::ArrayXd::LinSpaced(rows, 0, rows - 1) * cell_.x();
    MatrixXd of_nodes(rows, columns), along = MatrixXd::Zero(rows_, columns), result = MatrixXd::Zero(rows_, columns_);
    for (Index j = 0; j < columns; ++j)
        of_nodes.col(j) = correlation_at(correlation, u.square() + std::pow(j * cell_.y(), 2));
    for (Index p = -kHalfLength; p <= kHalfLength; ++p)
        for (Index i = 0; i < rows_; ++i) along.row(i) += convolved[p + kHalfLength] * of_nodes.row(std::abs(i + p));
    for (Index p = -kHalfLength; p <= kHalfLength; ++p)
        for (Index j = 0; j < columns_; ++j) result.col(j) += convolved[p + kHalfLength] * along.col(std::abs(j + p));
    return result;
}

void ControlHeights::add_block_toeplitz(MatrixXd& sum, const MatrixXd& by_offset) const
{
    for (Index column = 0; column < columns_; ++column)
        for (Index other = column; other < columns_; ++other)
            for (Index row = 0; row < rows_; ++row)
                for (Index i = 0; i < rows_; ++i)
                    sum(other * rows_ + i, column * rows_ + row) += by_offset(std::abs(i - row), other - column);
}

namespace {

/// What the correlations of a mixture share.
struct Trend {
    MatrixXd Q, F; ///< F: control heights
    VectorXd mean; ///< F Qᵀ z

    Trend(const ProcessTouches& touches, const MatrixXd& controls)
    {
        core::QrFactors factors = core::householder_qr(touches.F, touches.F.cols());
        Q = std::move(factors.Q);
        F = factors.R.transpose().triangularView<Eigen::Lower>().solve(controls.transpose()).transpose();
        mean = F * (Q.transpose() * touches.z);
    }
};

/// One correlation's moments over its amplitudes: of v, and Σ weight τ².
struct Amplitudes {
    double weight = 0, tau2 = 0;
    VectorXd mean;   ///< of v
    MatrixXd spread; ///< Σ weight ((v - mean) (v - mean)ᵀ - τ⁴ (σ² + τ² λ)⁻¹)

    Amplitudes(const Spectrum& s, double sigma, const std::array<double, kNumRatios>& weights)
        : mean(VectorXd::Zero(s.y.size())), spread(MatrixXd::Zero(s.y.size(), s.y.size()))
    {
        VectorXd explained = mean;
        for (int i = 0; i < kNumRatios; ++i) {
            if (weights[i] == 0) continue;
            const double ratio = amplitude_ratio(i), t2 = std::pow(ratio * sigma, 2);
            const VectorXd d = precision(s, ratio), v = t2 / sigma * d.cwiseProduct(s.y);
            weight += weights[i];
            tau2 += weights[i] * t2;
            explained += weights[i] * t2 * ratio * ratio * d;
            mean += weights[i] * v;
            spread.noalias() += weights[i] * v * v.transpose();
        }
        if (weight == 0) return;
        mean /= weight;
        spread.noalias() -= weight * mean * mean.transpose();
        spread.diagonal() -= explained;
    }
};

/// A correlation's share of the mixture. Its covariance is that of B v, cross Fᵀ + F crossᵀ and that by offset.
struct Part {
    double weight = 0;
    VectorXd mean;
    MatrixXd B, spread; ///< of v
    MatrixXd cross;
    MatrixXd by_offset; ///< Σ weight τ² correlation_by_offset()
};

/// Sums left rightᵀ, the sum being symmetric, and the correlations by offset.
MatrixXd symmetric_product(const MatrixXd& left, const MatrixXd& right, const ControlHeights& controls,
                           const MatrixXd& by_offset)
{
    constexpr Index kStrip = 32; // columns a task: a strip's part above the diagonal is computed in vain
    const Index n = left.rows();
    MatrixXd sum(n, n);
    tbb::parallel_for(Index{0}, (n + kStrip - 1) / kStrip, [&](Index k) {
        const Index first = k * kStrip, below = n - first, count = std::min(kStrip, below);
        core::multiply({left.data() + first, n}, {right.data() + first, n, 1}, below, left.cols(), count,
                       sum.data() + first * n + first, n);
    });
    controls.add_block_toeplitz(sum, by_offset);
    return sum.selfadjointView<Eigen::Lower>();
}

} // namespace

std::pair<VectorXd, MatrixXd> mix_processes(const ProcessTouches& touches, const ControlHeights& controls,
                                            const MatrixXd& trend_controls, const std::vector<Spectrum>& spectra,
                                            const std::vector<std::array<double, kNumRatios>>& weights)
{
    const Trend trend(touches, trend_controls);
    const MatrixXd among_touches = squared_distances(touches.xy, touches.xy);
    const MatrixXd from_nodes = squared_distances(controls.nodes(), touches.xy);
    std::vector<Part> parts(spectra.size());
    tbb::parallel_for(std::size_t{0}, spectra.size(), [&](std::size_t k) {
        const Spectrum& s = spectra[k];
        Amplitudes amplitudes(s, touches.sigma, weights[k]);
        if (amplitudes.weight == 0) return;
        const MatrixXd C = controls.correlation_with(s.correlation, touches.xy, from_nodes);
        const MatrixXd QK = trend.Q.transpose() * correlation_matrix(s.correlation, among_touches);
        Part& part = parts[k];
        part.weight = amplitudes.weight;
        part.B = core::product(C - core::product(trend.F, QK), s.E);
        part.spread = std::move(amplitudes.spread);
        part.mean = trend.mean + part.B * amplitudes.mean;
        part.cross = amplitudes.tau2 * (trend.F * (QK * trend.Q) / 2 - C * trend.Q) +
                     part.weight * touches.sigma * touches.sigma / 2 * trend.F;
        part.by_offset = amplitudes.tau2 * controls.correlation_by_offset(s.correlation);
    });
    std::erase_if(parts, [](const Part& part) { return part.weight == 0; });

    VectorXd mean = VectorXd::Zero(controls.size());
    MatrixXd cross = MatrixXd::Zero(trend.F.rows(), trend.F.cols()), by_offset = 0 * parts.front().by_offset;
    double sum = 0;
    for (const Part& part : parts) {
        mean += part.weight * part.mean;
        cross += part.cross;
        by_offset += part.by_offset;
        sum += part.weight;
    }
    mean /= sum;
    const Index p = trend.F.cols(), columns = spectra.front().E.cols() + 1;
    MatrixXd left(controls.size(), 2 * p + columns * parts.size()), right(left.rows(), left.cols());
    left.leftCols(2 * p) << cross, trend.F;
    right.leftCols(2 * p) << trend.F, cross;
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
        const Part& part = parts[k];
        left.middleCols(2 * p + columns * k, columns) << core::product(part.B, part.spread),
            part.weight * (part.mean - mean);
        right.middleCols(2 * p + columns * k, columns) << part.B, part.mean - mean;
    });
    return {mean, symmetric_product(left, right, controls, by_offset) / sum};
}

} // namespace fettle::fit
