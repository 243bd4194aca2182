#include "find/flat_top.h"

#include "core/cholesky.h"
#include "core/constants.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <vector>

namespace fettle::find {
namespace {

using Eigen::Index;

// The outermost cells of a region lie on its walls, unless it is so thin that hardly any others are left.
constexpr float kRim = 1;              // cells
constexpr double kMinInnerShare = 0.3; // of the region's cells
constexpr int kMinTopCells = 9;        // three by three
constexpr int kMaxSteps = 10;          // of concentration, which ends after three or four

/// The seen cells of a region without its rim; with it if hardly any others are left.
Mask top_of(const Mask& region, const Image& z)
{
    const Mask seen = region & finite(z), inner = (depth_of(region) > kRim) & seen;
    const int cells = cv::countNonZero(inner);
    return cells >= kMinTopCells && cells >= kMinInnerShare * cv::countNonZero(seen) ? inner : seen;
}

double median_of(const Eigen::VectorXd& values)
{
    return quantile_of({values.data(), values.data() + values.size()}, 0.5);
}

/// Median distance of heights at cells from their least trimmed squares plane, to which concentration steps converge
/// (Rousseeuw and Van Driessen 1999). @param kept  1 for the cells of the first step, else 0
double trimmed_median_distance(const std::vector<cv::Point>& cells, const Eigen::VectorXd& z, Eigen::VectorXd kept)
{
    double min_median = core::kInfinity;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Eigen::VectorXd distance = plane_residuals(cells, z, kept).cwiseAbs();
        const double median = median_of(distance);
        if (!(median < min_median)) break;
        min_median = median;
        kept = (distance.array() <= median).cast<double>();
    }
    return min_median;
}

} // namespace

double departure_from_plane(const Mask& region, const Image& height, const Image& z)
{
    std::vector<cv::Point> cells;
    cv::findNonZero(top_of(region, z), cells);
    if (Index(cells.size()) < kMinTopCells) return core::kInfinity;
    const Eigen::VectorXd heights = values_at(height, cells), levels = values_at(z, cells);
    const Eigen::VectorXd all = Eigen::VectorXd::Ones(heights.size());
    const Eigen::VectorXd upper = (heights.array() >= median_of(heights)).cast<double>();
    return std::min(trimmed_median_distance(cells, levels, all), trimmed_median_distance(cells, levels, upper));
}

Eigen::VectorXd values_at(const Image& image, const std::vector<cv::Point>& cells)
{
    Eigen::VectorXd values(Index(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) values[Index(k)] = image(cells[k]);
    return values;
}

Eigen::VectorXd plane_residuals(const std::vector<cv::Point>& cells, const Eigen::VectorXd& z,
                                const Eigen::VectorXd& weights)
{
    Eigen::MatrixXd A(Index(cells.size()), 3);
    for (std::size_t k = 0; k < cells.size(); ++k)
        A.row(Index(k)) << 1, cells[k].x - cells[0].x, cells[k].y - cells[0].y;
    const Eigen::MatrixXd weighted = weights.asDiagonal() * A;
    const Eigen::Vector3d plane = core::solve_ldlt(A.transpose() * weighted, weighted.transpose() * z);
    return z - A * plane;
}

} // namespace fettle::find
