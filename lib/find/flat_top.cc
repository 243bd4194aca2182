#include "find/flat_top.h"

#include "core/cholesky.h"

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

/// Each row 1 and a cell's place from the first one, in cells.
Eigen::MatrixXd plane_basis(const std::vector<cv::Point>& cells)
{
    Eigen::MatrixXd A(Index(cells.size()), 3);
    for (std::size_t k = 0; k < cells.size(); ++k)
        A.row(Index(k)) << 1, cells[k].x - cells[0].x, cells[k].y - cells[0].y;
    return A;
}

/// Coefficients of the weighted least squares plane through heights.
Eigen::Vector3d fitted_plane(const Eigen::MatrixXd& A, const Eigen::VectorXd& z, const Eigen::VectorXd& weights)
{
    const Eigen::MatrixXd weighted = weights.asDiagonal() * A;
    return core::solve_ldlt(A.transpose() * weighted, weighted.transpose() * z);
}

struct TrimmedPlane {
    double median = core::kInfinity; ///< distance of the heights from it
    Eigen::VectorXd kept;            ///< 1 for the cells that it was fitted to, else 0
};

/// The least trimmed squares plane, to which concentration steps converge (Rousseeuw and Van Driessen 1999).
/// @param kept  1 for the cells of the first step, else 0
TrimmedPlane trimmed_plane(const Eigen::MatrixXd& A, const Eigen::VectorXd& z, Eigen::VectorXd kept)
{
    TrimmedPlane best{core::kInfinity, kept};
    for (int step = 0; step < kMaxSteps; ++step) {
        const Eigen::VectorXd distance = (z - A * fitted_plane(A, z, kept)).cwiseAbs();
        const double median = median_of(distance);
        if (!(median < best.median)) break;
        best = {median, kept};
        kept = (distance.array() <= median).cast<double>();
    }
    return best;
}

} // namespace

Top measure_top(const Mask& region, const Image& height, const Image& z)
{
    std::vector<cv::Point> cells;
    cv::findNonZero(top_of(region, z), cells);
    if (Index(cells.size()) < kMinTopCells) return {};
    const Eigen::MatrixXd A = plane_basis(cells);
    const Eigen::VectorXd heights = values_at(height, cells), levels = values_at(z, cells);
    const Eigen::VectorXd upper = (heights.array() >= median_of(heights)).cast<double>();
    const TrimmedPlane of_all = trimmed_plane(A, levels, Eigen::VectorXd::Ones(heights.size()));
    const TrimmedPlane of_upper = trimmed_plane(A, levels, upper);
    const TrimmedPlane& plane = of_upper.median < of_all.median ? of_upper : of_all;
    return {plane.median, fitted_plane(A, heights, plane.kept).tail<2>().norm()};
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
    const Eigen::MatrixXd A = plane_basis(cells);
    return z - A * fitted_plane(A, z, weights);
}

} // namespace fettle::find
