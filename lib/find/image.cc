#include "find/image.h"

#include "geometry/quantiles.h"

#include <opencv2/imgproc.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::find {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

// Lower bound of a kernel's weight, relative to the full kernel, so that it can be divided by.
constexpr float kMinKernelWeight = 1e-6F;

/// Mask with a border of cells that are not in it.
Mask padded(const Mask& mask, int margin)
{
    Mask result;
    cv::copyMakeBorder(mask, result, margin, margin, margin, margin, cv::BORDER_CONSTANT, cv::Scalar(0));
    return result;
}

Mask inner(const Mask& mask, int margin)
{
    return mask(cv::Rect(margin, margin, mask.cols - 2 * margin, mask.rows - 2 * margin)).clone();
}

cv::Mat cross() { return cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}); }

} // namespace

Mask finite(const Image& image) { return image == image; }

double noise_sigma(const Image& z)
{
    std::vector<double> second_differences;
    second_differences.reserve(2 * z.total());
    const auto add = [&](float before, float here, float after) {
        const double difference = std::abs(double(before) - 2.0 * here + after);
        if (std::isfinite(difference)) second_differences.push_back(difference);
    };
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            if (x > 0 && x + 1 < z.cols) add(z(y, x - 1), z(y, x), z(y, x + 1));
            if (y > 0 && y + 1 < z.rows) add(z(y - 1, x), z(y, x), z(y + 1, x));
        }
    if (second_differences.empty()) return 0;
    // The second difference of three independent values has the variance (1 + 4 + 1) sigma².
    return geometry::kMedianToSigma * geometry::median(second_differences) / std::sqrt(6.0);
}

namespace {

/// Median of the values of a box that are finite.
float median_in(const Image& z, const cv::Rect& box, std::vector<float>& values)
{
    values.clear();
    for (int v = box.y; v < box.y + box.height; ++v)
        for (int u = box.x; u < box.x + box.width; ++u)
            if (const float value = z(v, u); std::isfinite(value)) values.push_back(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? kUnseen : *middle;
}

} // namespace

Image nan_median(const Image& z, int radius)
{
    const int side = 2 * radius + 1;
    const Mask seen = finite(z);
    // OpenCV's median does not handle gaps. It is valid where the square has none, which is most of an image.
    Image whole = z.clone(), result;
    whole.setTo(0, ~seen);
    cv::medianBlur(whole, result, side);
    Mask is_whole;
    cv::erode(seen, is_whole, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {-1, -1}, 1, cv::BORDER_CONSTANT,
              cv::Scalar(0));
    tbb::parallel_for(tbb::blocked_range<int>(0, z.rows), [&](const tbb::blocked_range<int>& rows) {
        std::vector<float> values;
        for (int y = rows.begin(); y < rows.end(); ++y)
            for (int x = 0; x < z.cols; ++x)
                if (!is_whole(y, x))
                    result(y, x) =
                        median_in(z, cv::Rect(x - radius, y - radius, side, side) & cv::Rect({0, 0}, z.size()), values);
    });
    return result;
}

Image smoothing_weight(const Mask& mask, double sigma)
{
    Image weight(mask.size(), 0.F);
    weight.setTo(1, mask);
    cv::GaussianBlur(weight, weight, {}, sigma, sigma, cv::BORDER_REFLECT);
    return cv::max(weight, kMinKernelWeight);
}

Image smoothed(const Image& z, const Mask& mask, double sigma, const Image& weight)
{
    Image sum(z.size(), 0.F), result;
    z.copyTo(sum, mask);
    cv::GaussianBlur(sum, sum, {}, sigma, sigma, cv::BORDER_REFLECT);
    cv::divide(sum, weight, result);
    result.setTo(kUnseen, ~mask);
    return result;
}

Image smoothed(const Image& z, const Mask& mask, double sigma)
{
    return smoothed(z, mask, sigma, smoothing_weight(mask, sigma));
}

Image filled(const Image& z)
{
    const Mask gaps = ~finite(z);
    cv::Mat distance;
    cv::Mat1i nearest;
    cv::distanceTransform(gaps, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
    std::vector<float> value_of(static_cast<std::size_t>(z.total()) + 1, 0.F);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x)
            if (!gaps(y, x)) value_of[std::size_t(nearest(y, x))] = z(y, x);
    Image result = z.clone();
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x)
            if (gaps(y, x)) result(y, x) = value_of[std::size_t(nearest(y, x))];
    return result;
}

Image coarsened(const Image& z, int factor)
{
    if (factor == 1) return z.clone();
    Image result((z.rows + factor - 1) / factor, (z.cols + factor - 1) / factor);
    tbb::parallel_for(0, result.rows, [&](int y) {
        for (int x = 0; x < result.cols; ++x) {
            double sum = 0;
            int count = 0;
            for (int v = y * factor; v < std::min(z.rows, (y + 1) * factor); ++v)
                for (int u = x * factor; u < std::min(z.cols, (x + 1) * factor); ++u)
                    if (std::isfinite(z(v, u))) sum += z(v, u), ++count;
            result(y, x) = 4 * count >= factor * factor ? static_cast<float>(sum / count) : kUnseen;
        }
    });
    return result;
}

Image refined(const Image& z, int factor, cv::Size size)
{
    if (factor == 1) return z.clone();
    Image large;
    cv::resize(z, large, {}, factor, factor, cv::INTER_LINEAR);
    return large(cv::Rect({0, 0}, size)).clone();
}

Image depth_of(const Mask& mask)
{
    Image result;
    cv::distanceTransform(padded(mask, 1), result, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    return result(cv::Rect(1, 1, mask.cols, mask.rows)).clone();
}

Image distance_to(const Mask& mask)
{
    if (cv::countNonZero(mask) == 0) return Image(mask.size(), static_cast<float>(mask.rows + mask.cols));
    Image result;
    cv::distanceTransform(~mask, result, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    return result;
}

Mask with_holes_filled(const Mask& mask)
{
    Mask around = ~padded(mask, 1);
    cv::floodFill(around, {0, 0}, cv::Scalar(0));
    return mask | inner(around, 1);
}

Mask dilated(const Mask& mask, int times)
{
    Mask result;
    cv::dilate(mask, result, cross(), {-1, -1}, times, cv::BORDER_CONSTANT, cv::Scalar(0));
    return result;
}

Mask eroded(const Mask& mask, int times)
{
    Mask result;
    cv::erode(mask, result, cross(), {-1, -1}, times, cv::BORDER_CONSTANT, cv::Scalar(0));
    return result;
}

Mask closed(const Mask& mask, int times)
{
    const int margin = times + 1;
    return inner(eroded(dilated(padded(mask, margin), times), times), margin);
}

Mask opened(const Mask& mask, int side)
{
    Mask result;
    const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {side, side});
    cv::erode(mask, result, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    // The anchor of an even square is not its middle: reflected, the opening stays inside of the mask.
    cv::dilate(result, result, square, {side - 1 - side / 2, side - 1 - side / 2}, 1, cv::BORDER_CONSTANT,
               cv::Scalar(0));
    return result;
}

cv::Rect Components::box(int k) const
{
    return {stats(k, cv::CC_STAT_LEFT), stats(k, cv::CC_STAT_TOP), stats(k, cv::CC_STAT_WIDTH),
            stats(k, cv::CC_STAT_HEIGHT)};
}

Components components(const Mask& mask, int connectivity)
{
    Components result;
    cv::Mat centroids;
    result.count =
        cv::connectedComponentsWithStats(mask, result.labels, result.stats, centroids, connectivity, CV_32S) - 1;
    return result;
}

std::vector<cv::Point> simplified_outline(const Mask& mask, double tolerance)
{
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    if (outlines.empty()) return {};
    const auto largest = std::ranges::max_element(
        outlines, {}, [](const std::vector<cv::Point>& outline) { return cv::contourArea(outline); });
    std::vector<cv::Point> corners;
    cv::approxPolyDP(*largest, corners, tolerance, true);
    return corners;
}

std::vector<double> values_in(const Image& image, const Mask& mask)
{
    std::vector<double> values;
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            if (mask(y, x) && std::isfinite(image(y, x))) values.push_back(image(y, x));
    return values;
}

double robust_sd(std::vector<double> numbers)
{
    if (numbers.empty()) return 0;
    const double middle = geometry::median(numbers);
    for (double& number : numbers) number = std::abs(number - middle);
    return geometry::kMedianToSigma * geometry::median(numbers);
}

double quantile_of(std::vector<double> numbers, double share)
{
    return numbers.empty() ? 0 : geometry::quantile(numbers, share);
}

cv::Rect grown_box(const cv::Rect& box, int margin, cv::Size size)
{
    return cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
           cv::Rect({0, 0}, size);
}

} // namespace fettle::find
