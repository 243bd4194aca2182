#include "belt/convolution.h"

#include <opencv2/core.hpp>

#include <cstdlib>

namespace fettle::belt {

/// OpenCV matrices are row-major, so that their rows are Eigen's columns.
struct Convolution::Buffers {
    int rows, columns;
    cv::Mat spectrum; ///< of the influence divided by the number of cells, CCS-packed
    cv::Mat padded, transformed;
};

Convolution::Convolution(const Eigen::MatrixXd& influence) : buffers_(std::make_unique<Buffers>())
{
    Buffers& w = *buffers_;
    w.rows = influence.rows();
    w.columns = influence.cols();
    const int padded_rows = cv::getOptimalDFTSize(2 * w.rows);
    const int padded_columns = cv::getOptimalDFTSize(2 * w.columns);
    w.padded = cv::Mat::zeros(padded_columns, padded_rows, CV_64F);
    for (int j = 1 - w.columns; j < w.columns; ++j)
        for (int i = 1 - w.rows; i < w.rows; ++i)
            w.padded.at<double>(j < 0 ? j + padded_columns : j, i < 0 ? i + padded_rows : i) =
                influence(std::abs(i), std::abs(j));
    cv::dft(w.padded, w.spectrum, cv::DFT_SCALE);
    w.padded.setTo(0);
}

Convolution::~Convolution() = default;
Convolution::Convolution(Convolution&&) noexcept = default;

void Convolution::operator()(const Eigen::MatrixXd& pressure, Eigen::MatrixXd& displacement) const
{
    Buffers& w = *buffers_;
    w.padded.setTo(0);
    for (int j = 0; j < w.columns; ++j) Eigen::VectorXd::Map(w.padded.ptr<double>(j), w.rows) = pressure.col(j);
    cv::dft(w.padded, w.transformed, 0, w.columns);
    cv::mulSpectrums(w.transformed, w.spectrum, w.transformed, 0);
    cv::dft(w.transformed, w.padded, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT, w.columns);
    displacement.resize(w.rows, w.columns);
    for (int j = 0; j < w.columns; ++j) displacement.col(j) = Eigen::VectorXd::Map(w.padded.ptr<double>(j), w.rows);
}

} // namespace fettle::belt
