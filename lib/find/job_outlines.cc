#include "find/job_outlines.h"

#include "geometry/division.h"
#include "job/joined.h"
#include "job/open_side.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <vector>

namespace fettle::find {
namespace {

// S ends so many cells before a place where the part departs from the surface around B.
constexpr double kEdgeCells = 2.5;
// Pixels are half cells.
constexpr int kMarginPixels = 8;  // around polygons
constexpr int kMinEdgePixels = 4; // minimum size of an edge: single cells are outliers of the noise
constexpr int kEdgePixels = int(2 * kEdgeCells);
constexpr double kSamplingPixels = 1.5, kBoundaryPixels = 0.8; // tolerances of the simplified outlines of S and B
// The part ends at B if it ends within this distance of B, by which B is clipped and its outline simplified.
constexpr int kOpenSidePixels = 4;
// Distance of B from the part's edge, where a stock still has a surface.
constexpr int kEdgeGapPixels = 3;
// B crosses an edge if more than this share of it lies beside the part.
constexpr double kMinClippedShare = 0.005;

constexpr double kSpacingStep = 0.9; // ratio of the spacings of corners that are tried

/// A window of half cells around polygons. Corners of the polygons are rounded to their centres.
struct HalfCells {
    Eigen::Vector2d low; // centre of the first pixel inside of the margin, mm
    double pixel;        // mm
    cv::Size size;

    HalfCells(const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b, double cell)
        : low(a.rowwise().minCoeff().cwiseMin(b.rowwise().minCoeff())), pixel(cell / 2)
    {
        const Eigen::Vector2d high = a.rowwise().maxCoeff().cwiseMax(b.rowwise().maxCoeff());
        const Eigen::Vector2d pixels = (high - low) / pixel;
        size = {int(pixels.x()) + 2 * kMarginPixels + 1, int(pixels.y()) + 2 * kMarginPixels + 1};
    }

    Eigen::Vector2d place(const cv::Point& p) const
    {
        return low + pixel * Eigen::Vector2d(p.x - kMarginPixels, p.y - kMarginPixels);
    }

    Mask inside(const Eigen::Matrix2Xd& polygon) const
    {
        std::vector<cv::Point> places;
        for (const auto& corner : polygon.colwise())
            places.emplace_back(cvRound((corner.x() - low.x()) / pixel) + kMarginPixels,
                                cvRound((corner.y() - low.y()) / pixel) + kMarginPixels);
        Mask mask(size, std::uint8_t(0));
        cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{places}, 255);
        return mask;
    }

    Mask where(const std::function<bool(const Eigen::Vector2d&)>& holds) const
    {
        Mask mask(size, std::uint8_t(0));
        for (int y = 0; y < mask.rows; ++y)
            for (int x = 0; x < mask.cols; ++x)
                if (holds(place({x, y}))) mask(y, x) = 255;
        return mask;
    }

    /// simplified_outline() of the mask, mm.
    Eigen::Matrix2Xd outline(const Mask& mask, double tolerance) const
    {
        const std::vector<cv::Point> corners = simplified_outline(mask, tolerance);
        Eigen::Matrix2Xd result(2, corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) result.col(Eigen::Index(i)) = place(corners[i]);
        return result;
    }
};

/// The half cells beside the part, without holes that lie inside of a mask.
Mask beside_part(const HalfCells& cells, const Mask& inside, const HeightMap& map, const Mask& part)
{
    const Mask off = cells.where([&](const Eigen::Vector2d& place) {
        const cv::Point cell = map.cell_of(place);
        return !cv::Rect({0, 0}, part.size()).contains(cell) || !part(cell);
    });
    const Components pieces = components(off);
    std::vector<bool> is_outside(std::size_t(pieces.count) + 1, false);
    for (int y = 0; y < off.rows; ++y)
        for (int x = 0; x < off.cols; ++x)
            if (!inside(y, x)) is_outside[std::size_t(pieces.labels(y, x))] = true;
    Mask beside(off.size(), std::uint8_t(0));
    for (int y = 0; y < off.rows; ++y)
        for (int x = 0; x < off.cols; ++x)
            if (const int piece = pieces.labels(y, x); piece > 0 && is_outside[std::size_t(piece)]) beside(y, x) = 255;
    return opened(beside, kMinEdgePixels);
}

/// B with its sides divided into equal pieces no longer than a spacing. New corners without metal are left out.
Eigen::Matrix2Xd divided(const Eigen::Matrix2Xd& boundary, const Eigen::Matrix2Xd& sampling, double spacing)
{
    std::vector<Eigen::Vector2d> corners;
    for (Eigen::Index k = 0; k < boundary.cols(); ++k) {
        const Eigen::Vector2d from = boundary.col(k), to = boundary.col((k + 1) % boundary.cols());
        const Eigen::Matrix2Xd added = geometry::division_points(from, to, spacing);
        corners.push_back(from);
        for (const Eigen::Index i : job::corners_on_metal(added, sampling)) corners.emplace_back(added.col(i));
    }
    return job::columns_to_matrix(corners);
}

} // namespace

Eigen::Matrix2Xd with_more_corners(const Eigen::Matrix2Xd& boundary, const Eigen::Matrix2Xd& sampling, double count,
                                   double min_spacing)
{
    Eigen::Matrix2Xd result = boundary;
    const double diagonal = (boundary.rowwise().maxCoeff() - boundary.rowwise().minCoeff()).norm();
    for (double spacing = diagonal; spacing >= min_spacing; spacing *= kSpacingStep) {
        if (double(job::corners_on_metal(result, sampling).size()) >= count) break;
        result = divided(boundary, sampling, spacing);
    }
    return result;
}

Eigen::Vector2d nearest_on(const Eigen::Matrix2Xd& polygon, const Eigen::Vector2d& point)
{
    Eigen::Vector2d nearest = polygon.col(0);
    for (Eigen::Index k = 0; k < polygon.cols(); ++k) {
        const Eigen::Vector2d from = polygon.col(k), along = polygon.col((k + 1) % polygon.cols()) - from;
        const double t = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        if ((from + t * along - point).norm() < (nearest - point).norm()) nearest = from + t * along;
    }
    return nearest;
}

Eigen::Matrix2Xd clipped_to_part(const Eigen::Matrix2Xd& boundary, const HeightMap& map, const Mask& part)
{
    const HalfCells cells(boundary, boundary, map.cell);
    const Mask inside = cells.inside(boundary), beside = beside_part(cells, inside, map, part);
    if (cv::countNonZero(inside & beside) <= kMinClippedShare * cv::countNonZero(inside)) return boundary;
    const Eigen::Matrix2Xd clipped =
        cells.outline(opened(inside & ~dilated(beside, kEdgeGapPixels), 3), kBoundaryPixels);
    return clipped.cols() >= 3 ? clipped : boundary;
}

Eigen::Matrix2Xd sampling_before_edges(const FoundAnomaly& anomaly, const HeightMap& map, const Mask& part,
                                       const std::function<bool(const Eigen::Vector2d&)>& is_good)
{
    Eigen::Matrix2Xd sampling = anomaly.sampling;
    for (auto corner : sampling.colwise()) {
        const Eigen::Vector2d from = nearest_on(anomaly.boundary, corner);
        const double length = (corner - from).norm();
        const Eigen::Vector2d along = (corner - from) / std::max(length, 1e-12);
        double reach = map.cell;
        while (reach <= length && is_good(from + reach * along)) reach += map.cell;
        if (reach <= length) corner = from + std::max(map.cell, reach - kEdgeCells * map.cell) * along;
    }
    // Corners are moved one by one: S may cross itself now, and an edge may run between two of them.
    const HalfCells cells(sampling, anomaly.boundary, map.cell);
    const Mask core = cells.inside(anomaly.boundary), outer = cells.inside(sampling);
    const Mask edges = dilated(opened(~core & ~cells.where(is_good), kMinEdgePixels), kEdgePixels);
    const Mask metal = opened(outer & ~edges, 3);
    // Where the part ends, cells between B and the edge belong to the anomaly and are no metal to touch.
    const bool is_open = cv::countNonZero(beside_part(cells, core, map, part) & dilated(core, kOpenSidePixels)) > 0;
    const Mask all = metal | (is_open ? core : dilated(core, 1));
    return job::joined(cells.outline(all, kSamplingPixels), anomaly.boundary); // simplified, it may cut corners of B
}

} // namespace fettle::find
