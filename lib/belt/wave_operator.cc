#include "belt/wave_operator.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <numbers>

namespace fettle::belt {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

namespace {

/// Rounding of a compliance that is the same from either end.
constexpr double kSymmetryTolerance = 1e-9;

bool is_symmetric(const MatrixXd& spectrum, Index columns)
{
    for (Index f = 0; f < spectrum.cols(); ++f) {
        const Eigen::Map<const MatrixXd> wave(spectrum.col(f).data(), columns, columns);
        if (!((wave - wave.reverse()).cwiseAbs().maxCoeff() <= kSymmetryTolerance * wave.cwiseAbs().maxCoeff()))
            return false;
    }
    return true;
}

} // namespace

WaveOperator::WaveOperator(Index rows, Index columns, const MatrixXd& spectrum)
    : rows_(rows), columns_(columns), is_symmetric_(is_symmetric(spectrum, columns)),
      odd_count_(is_symmetric_ ? columns / 2 : 0), even_count_(columns - odd_count_),
      even_(even_count_ * even_count_, rows + 1), odd_(odd_count_ * odd_count_, rows + 1)
{
    for (Index f = 0; f <= rows; ++f) {
        // A real inverse transform counts the waves between the first and the last one twice; the parts are sums of
        // two.
        const double factor = (f == 0 || f == rows ? 1 : 0.5) * (is_symmetric_ ? 0.5 : 1);
        const Eigen::Map<const MatrixXd> wave(spectrum.col(f).data(), columns, columns);
        const MatrixXd reversed = wave.rowwise().reverse();
        MatrixXd even = factor * wave.topLeftCorner(even_count_, even_count_);
        even.leftCols(odd_count_) += factor * reversed.topLeftCorner(even_count_, odd_count_);
        even_.col(f) = even.reshaped();
        odd_.col(f) = (factor * (wave - reversed).topLeftCorner(odd_count_, odd_count_)).reshaped();
    }
}

MatrixXd WaveOperator::displacement(const MatrixXd& pressure) const
{
    // A series a row: OpenCV's matrices are row-major. Its packed spectrum begins with the real first wave, goes on
    // with the real and imaginary part of each, and ends with the real last one.
    const int length = static_cast<int>(2 * rows_), count = static_cast<int>(pressure.cols());
    const Index half = is_symmetric_ ? count / 2 : 0, even_half = count - half, first = (columns_ - count) / 2;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    cv::Mat padded = cv::Mat::zeros(count, length, CV_64F), transformed;
    Eigen::Map<RowMajor> series(padded.ptr<double>(), count, length);
    const MatrixXd reversed = pressure.rowwise().reverse();
    if (is_symmetric_)
        series.topLeftCorner(even_half, rows_) = (pressure + reversed).leftCols(even_half).transpose();
    else
        series.leftCols(rows_) = pressure.transpose();
    series.bottomLeftCorner(half, rows_) = (pressure - reversed).leftCols(half).transpose();
    cv::dft(padded, transformed, cv::DFT_ROWS);
    Eigen::Map<RowMajor> packed(transformed.ptr<double>(), count, length);
    const MatrixXd amplitudes = packed;
    MatrixXd result(count, length);
    for (Index k = 0; k < length; ++k) {
        const Index f = (k + 1) / 2;
        const Eigen::Map<const MatrixXd> even(even_.col(f).data(), even_count_, even_count_);
        const Eigen::Map<const MatrixXd> odd(odd_.col(f).data(), odd_count_, odd_count_);
        result.col(k).head(even_half).noalias() =
            even.block(first, first, even_half, even_half) * amplitudes.col(k).head(even_half);
        result.col(k).tail(half).noalias() = odd.block(first, first, half, half) * amplitudes.col(k).tail(half);
    }
    packed = result;
    cv::dft(transformed, padded, cv::DFT_INVERSE | cv::DFT_ROWS | cv::DFT_REAL_OUTPUT);
    MatrixXd displacement(rows_, count);
    const Eigen::Map<const RowMajor> summed(padded.ptr<double>(), count, length);
    const MatrixXd even = summed.topLeftCorner(even_half, rows_).transpose(),
                   odd = summed.bottomLeftCorner(half, rows_).transpose();
    displacement.leftCols(even_half) = even;
    displacement.rightCols(half) = even.leftCols(half).rowwise().reverse();
    displacement.leftCols(half) += odd;
    displacement.rightCols(half) -= odd.rowwise().reverse();
    return displacement;
}

MatrixXd wave_transform(const MatrixXd& influence)
{
    const Index rows = influence.rows();
    MatrixXd transform(rows + 1, rows);
    for (Index f = 0; f <= rows; ++f)
        for (Index m = 0; m < rows; ++m)
            transform(f, m) =
                (m == 0 ? 1 : 2) * std::cos(pi * (f * m) / rows) * (f == 0 || f == rows ? 1 : 2) / (2.0 * rows);
    return transform * influence;
}

MatrixXd wave_weights(const std::vector<std::pair<double, double>>& nodes, Index rows)
{
    MatrixXd influence(rows, std::ssize(nodes));
    for (Index k = 0; k < influence.cols(); ++k)
        for (Index m = 0; m < rows; ++m) influence(m, k) = nodes[k].second * std::cos(m * nodes[k].first);
    return wave_transform(influence).transpose();
}

} // namespace fettle::belt
