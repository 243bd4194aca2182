#include "margin/anomaly_grid.h"

#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle {

namespace {

// In steps of the grid: corners of a finely drawn outline that are nearer together are one place.
constexpr double kNear = 1.0 / 8;

Polygon thinned(const Polygon& polygon, double least)
{
    Polygon kept(2, polygon.cols());
    Eigen::Index count = 0;
    for (const Eigen::Vector2d& corner : polygon.colwise())
        if (count == 0 || (corner - kept.col(count - 1)).norm() >= least) kept.col(count++) = corner;
    return kept.leftCols(count);
}

} // namespace

Eigen::Matrix2Xd anomaly_grid(const Job& job, int across)
{
    const Polygon anomaly = boundaries(job).anomaly;
    const Eigen::Vector2d least = anomaly.rowwise().minCoeff();
    const Eigen::Vector2d size = anomaly.rowwise().maxCoeff() - least;
    const double step = size.maxCoeff() / across;

    const Polygon corners = thinned(anomaly, kNear * step);
    std::vector<Eigen::Vector2d> points;
    for (Eigen::Index k = 0; k < corners.cols(); ++k) points.push_back(corners.col(k));
    for (Eigen::Index k = 0; k < corners.cols(); ++k) {
        const Eigen::Vector2d side = corners.col((k + 1) % corners.cols()) - corners.col(k);
        const double parts = std::ceil(side.norm() / step);
        for (double i = 1; i < parts; ++i) points.push_back(corners.col(k) + i / parts * side);
    }
    const Eigen::Vector2d parts = (size / step).array().ceil();
    for (double row = 0.5; row < parts.y(); ++row)
        for (double column = 0.5; column < parts.x(); ++column) {
            const Eigen::Vector2d xy = least + size.cwiseProduct(Eigen::Vector2d(column, row).cwiseQuotient(parts));
            if (contains(anomaly, xy)) points.push_back(xy);
        }
    Eigen::Matrix2Xd working(2, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) working.col(static_cast<Eigen::Index>(i)) = points[i];
    return rotation_working_machine(job.theta).transpose() * working;
}

} // namespace fettle
