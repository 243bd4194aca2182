#include "find/height_map.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

// A cell is an outlier if it differs from the median around by more than noise and slope explain, in a connected
// component of at most four such cells: flying points are single, anomalies are not.
constexpr double kOutlierSigmas = 8;
constexpr double kOutlierSlopes = 2.5; // of the median's change from cell to cell
constexpr int kMaxOutlierCells = 4;

constexpr int kFillRounds = 2;
constexpr int kMinFillNeighbours = 5; // of nine cells: the majority
constexpr int kMinSpeckCells = 30;    // a smaller component has no ring to fit a surface to

// Lower bound of the noise, in cells: smaller differences are rounding of files.
constexpr double kMinSigmaCells = 1e-4;

/// The larger of the changes of an image along x and y, per cell; 0 beside gaps.
Image slope_of(const Image& z)
{
    Image slope(z.size(), 0.F);
    tbb::parallel_for(0, z.rows, [&](int y) {
        for (int x = 0; x < z.cols; ++x) {
            const auto change = [&](int dx, int dy) {
                const int x0 = std::max(0, x - dx), x1 = std::min(z.cols - 1, x + dx);
                const int y0 = std::max(0, y - dy), y1 = std::min(z.rows - 1, y + dy);
                const float steps = static_cast<float>(std::max(1, x1 - x0 + y1 - y0));
                return (z(y1, x1) - z(y0, x0)) / steps;
            };
            const float size = std::hypot(change(1, 0), change(0, 1));
            if (std::isfinite(size)) slope(y, x) = size;
        }
    });
    return slope;
}

/// @param median  of the cells around each   @param slope  of the median
void remove_outliers(Image& z, const Image& median, const Image& slope, double sigma)
{
    Mask differs(z.size(), 0);
    tbb::parallel_for(0, z.rows, [&](int y) {
        for (int x = 0; x < z.cols; ++x)
            if (std::abs(z(y, x) - median(y, x)) > kOutlierSigmas * sigma + kOutlierSlopes * slope(y, x))
                differs(y, x) = 255;
    });
    const Components groups = components(differs, 8);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x)
            if (const int k = groups.labels(y, x); k > 0 && groups.area(k) <= kMaxOutlierCells)
                z(y, x) = std::numeric_limits<float>::quiet_NaN();
}

void fill_small_holes(Image& z)
{
    for (int round = 0; round < kFillRounds; ++round) {
        Image count(z.size(), 0.F);
        count.setTo(1, finite(z));
        cv::boxFilter(count, count, CV_32F, {3, 3}, {-1, -1}, false, cv::BORDER_REFLECT);
        const Mask fills = ~finite(z) & (count >= float(kMinFillNeighbours));
        if (cv::countNonZero(fills) > 0) nan_median(z, 1).copyTo(z, fills);
    }
}

} // namespace

HeightMap coarsened(const HeightMap& map, int factor)
{
    if (factor == 1) return map;
    HeightMap coarse{
        coarsened(map.z, factor), factor * map.cell, map.point_at(0.5 * (factor - 1), 0.5 * (factor - 1)), {}, 0};
    coarse.seen = finite(coarse.z);
    coarse.sigma = std::max(noise_sigma(coarse.z), map.sigma / factor);
    return coarse;
}

Mask coarsened(const Mask& mask, int factor)
{
    if (factor == 1) return mask;
    Mask coarse((mask.rows + factor - 1) / factor, (mask.cols + factor - 1) / factor, std::uint8_t(0));
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (mask(y, x)) coarse(y / factor, x / factor) = 255;
    return coarse;
}

void clean(HeightMap& map, bool fills)
{
    map.z = map.z.clone();
    Image median, slope;
    tbb::parallel_invoke(
        [&] {
            map.sigma = std::max({noise_sigma(map.z), map.sigma, kMinSigmaCells * map.cell});
        },
        [&] {
            median = nan_median(map.z, 2);
            slope = slope_of(median);
        });
    remove_outliers(map.z, median, slope, map.sigma);
    if (fills) fill_small_holes(map.z);
    const Components pieces = components(finite(map.z));
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x)
            if (const int k = pieces.labels(y, x); k > 0 && pieces.area(k) < kMinSpeckCells)
                map.z(y, x) = std::numeric_limits<float>::quiet_NaN();
    map.seen = finite(map.z);
}

} // namespace fettle::find
