#include "margin/anomaly_grid.h"

#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle {

Eigen::Matrix2Xd anomaly_grid(const Job& job, int across)
{
    const Polygon anomaly = boundaries(job).anomaly;
    const Eigen::Vector2d least = anomaly.rowwise().minCoeff();
    const Eigen::Vector2d size = anomaly.rowwise().maxCoeff() - least;
    const double step = size.maxCoeff() / across;

    std::vector<Eigen::Vector2d> points;
    for (Eigen::Index k = 0; k < anomaly.cols(); ++k) points.push_back(anomaly.col(k));
    for (Eigen::Index k = 0; k < anomaly.cols(); ++k) {
        const Eigen::Vector2d side = anomaly.col((k + 1) % anomaly.cols()) - anomaly.col(k);
        const double parts = std::ceil(side.norm() / step);
        for (double i = 1; i < parts; ++i) points.push_back(anomaly.col(k) + i / parts * side);
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
