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

/// Median distance from the least trimmed squares plane that concentration steps come to (Rousseeuw and Van Driessen
/// 1999). @param A  rows 1, x, y   @param kept  1: to begin with, 0: not
double concentrated(const Eigen::MatrixXd& A, const Eigen::VectorXd& z, Eigen::VectorXd kept)
{
    double min_median = core::kInfinity;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Eigen::MatrixXd K = kept.asDiagonal() * A;
        const Eigen::Vector3d plane = core::solve_ldlt(A.transpose() * K, K.transpose() * z);
        const Eigen::VectorXd distance = (z - A * plane).cwiseAbs();
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
    const auto count = Index(cells.size());
    if (count < kMinTopCells) return core::kInfinity;
    Eigen::MatrixXd A(count, 3);
    Eigen::VectorXd heights(count), levels(count);
    for (Index k = 0; k < count; ++k) {
        const cv::Point& cell = cells[std::size_t(k)];
        A.row(k) << 1, cell.x - cells[0].x, cell.y - cells[0].y;
        heights[k] = height(cell);
        levels[k] = z(cell);
    }
    const Eigen::VectorXd all = Eigen::VectorXd::Ones(count);
    const Eigen::VectorXd upper = (heights.array() >= median_of(heights)).cast<double>();
    return std::min(concentrated(A, levels, all), concentrated(A, levels, upper));
}

} // namespace fettle::find
