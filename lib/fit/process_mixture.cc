#include "fit/process_mixture.h"

#include "core/decompositions.h"

#include <Eigen/Geometry>

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

} // namespace

ControlHeights::ControlHeights(const surface::Bspline& grid)
    : rows_(grid.heights.rows()), columns_(grid.heights.cols()), cell_(grid.cell),
      nodes_(2, (rows_ + 2 * kExtraNodes) * (columns_ + 2 * kExtraNodes))
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
        const auto f = values.col(k).reshaped(rows_ + 2 * kExtraNodes, columns_ + 2 * kExtraNodes);
        along.setZero();
        for (Index p = 0; p <= 2 * kExtraNodes; ++p) along += kPrefilter[p] * f.middleRows(p, rows_);
        auto controls = result.col(k).reshaped(rows_, columns_);
        controls.setZero();
        for (Index p = 0; p <= 2 * kExtraNodes; ++p) controls += kPrefilter[p] * along.middleCols(p, columns_);
    }
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

ProcessMixture::ProcessMixture(const ProcessTouches& touches, const ControlHeights& controls, const MatrixXd& trend)
    : touches_(touches), controls_(controls)
{
    core::QrFactors F = core::householder_qr(touches.F, touches.F.cols());
    Q_ = std::move(F.Q);
    F_ = F.R.transpose().triangularView<Eigen::Lower>().solve(trend.transpose()).transpose();
    trend_ = F_ * (Q_.transpose() * touches.z);
}

void ProcessMixture::add(const Spectrum& s, const std::array<double, kNumRatios>& weights)
{
    double sum = 0, tau2 = 0;
    const double sigma = touches_.sigma;
    VectorXd mean = VectorXd::Zero(s.y.size()), explained = mean;
    MatrixXd spread = MatrixXd::Zero(s.y.size(), s.y.size());
    for (int i = 0; i < kNumRatios; ++i) {
        const double weight = weights[i];
        if (weight == 0) continue;
        const double ratio = amplitude_ratio(i), t2 = std::pow(ratio * sigma, 2);
        const VectorXd d = precision(s, ratio), v = t2 / sigma * d.cwiseProduct(s.y);
        sum += weight;
        tau2 += weight * t2;
        explained += weight * t2 * ratio * ratio * d;
        mean += weight * v;
        spread.noalias() += weight * v * v.transpose();
    }
    if (sum == 0) return;
    mean /= sum;
    spread.noalias() -= sum * mean * mean.transpose();
    spread.diagonal() -= explained;

    const MatrixXd C = controls_.from_values(correlation_matrix(s.correlation, controls_.nodes(), touches_.xy));
    const MatrixXd QK = Q_.transpose() * correlation_matrix(s.correlation, touches_.xy, touches_.xy);
    const MatrixXd B = (C - F_ * QK) * s.E;
    const MatrixXd cross = tau2 * (F_ * (QK * Q_) / 2 - C * Q_) + sum * sigma * sigma / 2 * F_;
    Part part{sum, trend_ + B * mean, MatrixXd(B.rows(), B.cols() + 2 * F_.cols()), {}};
    part.right.resizeLike(part.left);
    part.left << B * spread, cross, F_;
    part.right << B, F_, cross;
    parts_.push_back(std::move(part));
    if (by_offset_.size() == 0)
        by_offset_ = tau2 * controls_.correlation_by_offset(s.correlation);
    else
        by_offset_ += tau2 * controls_.correlation_by_offset(s.correlation);
}

std::pair<VectorXd, MatrixXd> ProcessMixture::result() const
{
    VectorXd mean = VectorXd::Zero(controls_.size());
    double sum = 0;
    Index columns = 0;
    for (const Part& part : parts_) {
        mean += part.weight * part.mean;
        sum += part.weight;
        columns += part.left.cols() + 1;
    }
    mean /= sum;
    MatrixXd left(controls_.size(), columns), right(controls_.size(), columns);
    Index k = 0;
    for (const Part& part : parts_) {
        const Index count = part.left.cols();
        left.middleCols(k, count + 1) << part.left, part.weight * (part.mean - mean);
        right.middleCols(k, count + 1) << part.right, part.mean - mean;
        k += count + 1;
    }
    MatrixXd covariance = MatrixXd::Zero(controls_.size(), controls_.size());
    covariance.triangularView<Eigen::Lower>() += left * right.transpose();
    controls_.add_block_toeplitz(covariance, by_offset_);
    covariance = MatrixXd(covariance.selfadjointView<Eigen::Lower>()) / sum;
    return {mean, covariance};
}

} // namespace fettle::fit
