#include "belt/convolution.h"

#include <opencv2/core.hpp>

#include <cstdlib>

namespace fettle {

using Eigen::Index;

/// OpenCV's rows are Eigen's columns.
struct Convolution::Work {
    Index rows, columns;
    cv::Mat spectrum; ///< of the influence, over the number of cells: CCS-packed
    cv::Mat padded, transformed;
};

Convolution::Convolution(const Eigen::MatrixXd& influence) : work_(std::make_unique<Work>())
{
    Work& w = *work_;
    w.rows = influence.rows();
    w.columns = influence.cols();
    const int across = cv::getOptimalDFTSize(static_cast<int>(2 * w.rows));
    const int along = cv::getOptimalDFTSize(static_cast<int>(2 * w.columns));
    w.padded = cv::Mat::zeros(along, across, CV_64F);
    for (Index j = 1 - w.columns; j < w.columns; ++j)
        for (Index i = 1 - w.rows; i < w.rows; ++i)
            w.padded.at<double>(static_cast<int>(j < 0 ? j + along : j), static_cast<int>(i < 0 ? i + across : i)) =
                influence(std::abs(i), std::abs(j));
    cv::dft(w.padded, w.spectrum, cv::DFT_SCALE);
    w.padded.setTo(0);
}

Convolution::~Convolution() = default;
Convolution::Convolution(Convolution&&) noexcept = default;

void Convolution::operator()(const Eigen::MatrixXd& pressure, Eigen::MatrixXd& displacement) const
{
    Work& w = *work_;
    const int rows = static_cast<int>(w.rows), columns = static_cast<int>(w.columns);
    w.padded.setTo(0);
    for (int j = 0; j < columns; ++j) Eigen::VectorXd::Map(w.padded.ptr<double>(j), rows) = pressure.col(j);
    cv::dft(w.padded, w.transformed, 0, columns);
    cv::mulSpectrums(w.transformed, w.spectrum, w.transformed, 0);
    cv::dft(w.transformed, w.padded, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT, columns);
    displacement.resize(rows, columns);
    for (int j = 0; j < columns; ++j) displacement.col(j) = Eigen::VectorXd::Map(w.padded.ptr<double>(j), rows);
}

} // namespace fettle
