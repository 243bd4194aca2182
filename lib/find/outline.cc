#include "find/outline.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

constexpr int kClosing = 3;        // cells: dents of B that no wheel follows
constexpr double kGrowth = 3.2;    // beyond the region: its foot, and the tolerance of the simplified outline
constexpr double kFootGap = 1.7;   // beyond a measured foot: the tolerance of the simplified outline, and a cell
constexpr double kOthersGap = 1.5; // between B and another anomaly, cells

constexpr double kSamplingPerThickness = 0.6;
constexpr double kMinSampling = 5.5, kMaxSampling = 45; // width of S around B, cells
constexpr double kEdgeGap = 1.5;                        // S keeps off edges, cells

constexpr int kOutlineCells = 4;     // around what an outline surrounds, for its blur and simplification, cells
constexpr int kUpscale = 4;          // of masks before their outline is taken
constexpr double kOutlineBlur = 0.7; // cells, removes the steps of the pixels
constexpr double kBoundaryDetail = 0.6, kSamplingDetail = 0.8; // of simplified outlines, cells

/// The outline of the mask's largest component.
Eigen::Matrix2Xd polygon_of(const Mask& mask, double tolerance)
{
    const cv::Rect box = cv::boundingRect(mask);
    if (box.empty()) return {};
    Mask large;
    cv::resize(mask(box), large, {}, kUpscale, kUpscale, cv::INTER_NEAREST);
    constexpr int kBorder = 2 * kUpscale; // more than the blur's reach
    cv::copyMakeBorder(large, large, kBorder, kBorder, kBorder, kBorder, cv::BORDER_CONSTANT, 0);
    cv::GaussianBlur(large, large, {}, kUpscale * kOutlineBlur);
    const std::vector<cv::Point> corners = simplified_outline(large > 127, tolerance * kUpscale);
    Eigen::Matrix2Xd polygon(2, Eigen::Index(corners.size()));
    for (std::size_t k = 0; k < corners.size(); ++k)
        polygon.col(Eigen::Index(k)) << box.x + (corners[k].x - kBorder + 0.5) / kUpscale - 0.5,
            box.y + (corners[k].y - kBorder + 0.5) / kUpscale - 0.5;
    return polygon;
}

/// The cell of the mask nearest to each cell.
cv::Mat2i nearest_cells(const Mask& mask)
{
    Image distance;
    cv::Mat1i labels;
    cv::distanceTransform(~mask, distance, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
    std::vector<cv::Vec2i> cell_of(mask.total() + 1);
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (mask(y, x)) cell_of[std::size_t(labels(y, x))] = {x, y};
    cv::Mat2i nearest(mask.size());
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x) nearest(y, x) = cell_of[std::size_t(labels(y, x))];
    return nearest;
}

/// Cells within `width` of B that are seen from their nearest cell of B over good metal alone.
Mask ring_in_sight(const Mask& inside, const Mask& good, double width)
{
    const Image distance = distance_to(inside);
    const cv::Mat2i nearest = nearest_cells(inside);
    Mask ring(inside.size(), 0);
    for (int y = 0; y < ring.rows; ++y)
        for (int x = 0; x < ring.cols; ++x) {
            if (distance(y, x) > width || inside(y, x)) continue;
            const cv::Vec2i from = nearest(y, x);
            const int steps = int(std::ceil(distance(y, x)));
            bool is_open = true;
            for (int k = 1; k <= steps && is_open; ++k) {
                const int u = cvRound(from[0] + double(k) / steps * (x - from[0]));
                const int v = cvRound(from[1] + double(k) / steps * (y - from[1]));
                is_open = good(v, u) || inside(v, u);
            }
            if (is_open) ring(y, x) = 255;
        }
    return ring;
}

double max_depth(const Mask& mask)
{
    double max = 0;
    cv::minMaxLoc(depth_of(mask), nullptr, &max);
    return max;
}

Mask with_seed(const Mask& mask, const Mask& seed)
{
    const Components parts = components(mask);
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (seed(y, x) && parts.labels(y, x) > 0) return parts.labels == parts.labels(y, x);
    return mask;
}

} // namespace

Outlines outlines_of(const HeightMap& map, const Mask& region, const Mask& others, int growth)
{
    const double beyond = std::max(kGrowth, growth + kFootGap);
    const cv::Rect own_box = cv::boundingRect(region);
    const double max_thickness = 2 * (max_depth(region(own_box)) + kClosing);
    const int reach = int(std::ceil(beyond)) + kClosing + kOutlineCells;
    const int margin =
        reach + int(std::ceil(std::clamp(kSamplingPerThickness * max_thickness, kMinSampling, kMaxSampling)));
    const cv::Rect box = grown_box(own_box, margin, region.size());
    const auto around = [&](const Mask& mask) { // cells beyond the map are not seen
        Mask result;
        cv::copyMakeBorder(mask(box), result, reach, reach, reach, reach, cv::BORDER_CONSTANT, 0);
        return result;
    };
    const Mask own = with_holes_filled(closed(around(region), kClosing)), other = around(others),
               seen = around(map.seen);
    const double thickness = 2 * max_depth(own);
    const Image to_others = distance_to(other);
    const Mask inside = with_seed((distance_to(own) <= beyond) & ((to_others >= kOthersGap) | own), own);
    const Mask good = seen & (to_others > beyond + 1) & (depth_of(closed(seen, 1)) > kEdgeGap);
    const double width = std::clamp(kSamplingPerThickness * thickness, kMinSampling, kMaxSampling);
    const Mask sampling = with_holes_filled(with_seed(opened(ring_in_sight(inside, good, width + 1) | inside, 2), own));
    Outlines result;
    const Eigen::Vector2d shift(box.x - reach, box.y - reach);
    result.boundary = polygon_of(inside, kBoundaryDetail).colwise() + shift;
    result.sampling = polygon_of(sampling | inside, kSamplingDetail).colwise() + shift;
    result.inside = Mask(region.size(), 0);
    inside(cv::Rect(reach, reach, box.width, box.height)).copyTo(result.inside(box));
    return result;
}

} // namespace fettle::find
