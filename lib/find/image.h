#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <vector>

/// Filters of images with gaps. Lengths are in cells unless stated otherwise. The files of lib/find that include this
/// header see OpenCV; those of other modules do not.
namespace fettle::find {

using Image = cv::Mat1f; ///< one number a cell; NaN: nothing seen there
using Mask = cv::Mat1b;  ///< 255: true, 0: false

/// Cells with a value; ~finite(image) those without. `image != image` is no way to find these: OpenCV compares by
/// instructions for which NaN is unequal to itself on some processors, and not on others (AVX2).
Mask finite(const Image& image);

/// Standard deviation of white noise, from second differences along rows and columns, which are free of slopes; 0 if
/// no three cells in a line have values.
double noise_sigma(const Image& z);

/// Median of the values among the (2 radius + 1)² cells around each; NaN where there are none. @param radius  1 or 2
Image nan_median(const Image& z, int radius);

/// Gaussian smoothing of the cells of a mask by those of the mask alone (normalized convolution, Knutsson & Westin
/// 1993); NaN elsewhere. @param sigma  cells
Image smoothed(const Image& z, const Mask& mask, double sigma);
/// Smoothing with a precomputed smoothing_weight(), which several images of one mask share.
Image smoothed(const Image& z, const Mask& mask, double sigma, const Image& weight);
Image smoothing_weight(const Mask& mask, double sigma);

/// Each cell without a value gets that of the nearest cell that has one. @throws cv::Exception if none has
Image filled(const Image& z);

/// Means of factor x factor cells; NaN where fewer than a quarter of them have values.
Image coarsened(const Image& z, int factor);
/// The inverse of coarsened(): linear interpolation. @param z  without gaps
Image refined(const Image& z, int factor, cv::Size size);

/// Distance of each cell of the mask to the nearest cell that is not, which may lie beyond the image's edge.
Image depth_of(const Mask& mask);
/// Distance of each cell to the nearest cell of the mask; large if the mask is empty.
Image distance_to(const Mask& mask);

/// The mask and what it encloses.
Mask with_holes_filled(const Mask& mask);

/// Morphology with the four neighbours, repeated. Beyond the image's edge there is nothing.
Mask dilated(const Mask& mask, int times);
Mask eroded(const Mask& mask, int times);
Mask closed(const Mask& mask, int times);
/// Opening by a square of `side` cells.
Mask opened(const Mask& mask, int side);

/// Components of four (or eight) connected cells.
struct Components {
    cv::Mat1i labels; ///< 0: none
    cv::Mat1i stats;  ///< row k: as cv::connectedComponentsWithStats()
    int count = 0;    ///< labels go from 1 to count

    int area(int k) const { return stats(k, cv::CC_STAT_AREA); }
    cv::Rect box(int k) const;
};
Components components(const Mask& mask, int connectivity = 4);

/// The simplified outline of a mask's largest component (Douglas & Peucker); empty for an empty mask.
/// @param tolerance  largest distance of the outline from its simplification, cells
std::vector<cv::Point> simplified_outline(const Mask& mask, double tolerance);

/// Values of the cells of a mask that have one, row by row.
std::vector<double> values_in(const Image& image, const Mask& mask);
/// Robust standard deviation of numbers about their median; 0 if there is none.
double robust_sd(std::vector<double> numbers);
/// The number at a share of the sorted numbers; 0 if there is none.
double quantile_of(std::vector<double> numbers, double share);

/// A box grown by `margin` cells on each side, within an image.
cv::Rect grown_box(const cv::Rect& box, int margin, cv::Size size);

} // namespace fettle::find
