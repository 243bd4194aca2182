#include "margin/anomaly_grid.h"

#include "geometry/bounding_box.h"
#include "geometry/division.h"
#include "job/boundary.h"

#include <vector>

namespace fettle::margin {

namespace {

// Corners of a finely drawn outline that are closer than this are merged.
constexpr double kMinCornerDistanceSteps = 1.0 / 8;

job::Polygon merge_close_corners(const job::Polygon& polygon, double min_distance)
{
    job::Polygon kept(2, polygon.cols());
    Eigen::Index count = 0;
    for (const Eigen::Vector2d& corner : polygon.colwise())
        if (count == 0 || (corner - kept.col(count - 1)).norm() >= min_distance) kept.col(count++) = corner;
    return kept.leftCols(count);
}

} // namespace

Eigen::Matrix2Xd anomaly_grid(const job::Job& job, int across)
{
    const job::Polygon anomaly = job::working_boundaries(job).anomaly;
    const Eigen::AlignedBox2d box = geometry::bounding_box(anomaly);
    const Eigen::Vector2d size = box.sizes();
    const double step = size.maxCoeff() / across;

    const job::Polygon corners = merge_close_corners(anomaly, kMinCornerDistanceSteps * step);
    std::vector<Eigen::Vector2d> points;
    for (Eigen::Index k = 0; k < corners.cols(); ++k) points.push_back(corners.col(k));
    for (Eigen::Index k = 0; k < corners.cols(); ++k) {
        const Eigen::Index next = (k + 1) % corners.cols();
        const Eigen::Matrix2Xd added = geometry::division_points(corners.col(k), corners.col(next), step);
        for (const auto& point : added.colwise()) points.emplace_back(point);
    }
    const Eigen::Vector2d parts = (size / step).array().ceil();
    for (double row = 0.5; row < parts.y(); ++row)
        for (double column = 0.5; column < parts.x(); ++column) {
            const Eigen::Vector2d xy = box.min() + size.cwiseProduct(Eigen::Vector2d(column, row).cwiseQuotient(parts));
            if (job::contains(anomaly, xy)) points.push_back(xy);
        }
    return job::rotation_working_machine(job.theta).transpose() * job::columns_to_matrix(points);
}

} // namespace fettle::margin
