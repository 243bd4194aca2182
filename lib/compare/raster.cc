#include "compare/raster.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

Raster empty_raster(const View& view)
{
    Raster raster;
    raster.value = ArrayXXd::Constant(view.rows, view.columns, std::numeric_limits<double>::quiet_NaN());
    raster.covered.setConstant(view.rows, view.columns, false);
    return raster;
}

/// Gaussian filter along the columns, over what is covered; the border is left out.
ArrayXXd blurred_down(const ArrayXXd& image, double sigma)
{
    const Index reach = static_cast<Index>(std::ceil(3 * sigma)); // beyond 3σ lies 0.3 % of the weight
    Eigen::ArrayXd weights(2 * reach + 1);
    for (Index k = -reach; k <= reach; ++k) weights[k + reach] = std::exp(-0.5 * std::pow(double(k) / sigma, 2));
    weights /= weights.sum();
    ArrayXXd result = ArrayXXd::Zero(image.rows(), image.cols());
    for (Index j = 0; j < image.cols(); ++j)
        for (Index i = 0; i < image.rows(); ++i) {
            const Index first = std::max<Index>(0, i - reach), last = std::min(image.rows() - 1, i + reach);
            result(i, j) =
                (weights.segment(first - i + reach, last - first + 1) * image.col(j).segment(first, last - first + 1))
                    .sum();
        }
    return result;
}

ArrayXXd blurred(const ArrayXXd& image, double sigma)
{
    return blurred_down(blurred_down(image, sigma).transpose(), sigma).transpose();
}

} // namespace

double point_spacing(const Eigen::Matrix2Xd& xy)
{
    std::vector<Vector2d> points;
    for (const Vector2d& p : xy.colwise())
        if (p.allFinite()) points.push_back(p);
    if (points.size() < 2) return 0;
    Vector2d least = points[0], most = points[0];
    for (const Vector2d& p : points) {
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
    }
    const Vector2d size = most - least;
    // Buckets of about one point; a line of points has no area.
    const double share =
        std::max(std::sqrt(size.prod() / double(points.size())), size.maxCoeff() / double(points.size()));
    if (!(share > 0)) return 0;
    const Eigen::Array2i count = (size.array() / share).cast<int>() + 1;
    const auto bucket_of = [&](const Vector2d& p) -> Eigen::Array2i {
        return ((p - least).array() / share).cast<int>();
    };
    std::vector<int> first(static_cast<std::size_t>(count.prod()), -1), next(points.size(), -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Array2i b = bucket_of(points[i]);
        int& head = first[static_cast<std::size_t>(b.y() * count.x() + b.x())];
        next[i] = head;
        head = static_cast<int>(i);
    }
    // The median of so many nearest distances is near enough to that of all.
    constexpr std::size_t kProbed = 2000;
    const std::size_t step = std::max<std::size_t>(1, points.size() / kProbed);
    std::vector<double> nearest;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const Eigen::Array2i b = bucket_of(points[i]);
        double best = std::numeric_limits<double>::infinity();
        for (int y = std::max(0, b.y() - 1); y <= std::min(count.y() - 1, b.y() + 1); ++y)
            for (int x = std::max(0, b.x() - 1); x <= std::min(count.x() - 1, b.x() + 1); ++x)
                for (int k = first[static_cast<std::size_t>(y * count.x() + x)]; k >= 0;
                     k = next[static_cast<std::size_t>(k)])
                    if (const double d = (points[static_cast<std::size_t>(k)] - points[i]).norm(); d > 0)
                        best = std::min(best, d);
        nearest.push_back(std::min(best, 2 * share));
    }
    std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
    return nearest[nearest.size() / 2];
}

Raster rasterise(const View& view, const Eigen::Matrix2Xd& xy, const Eigen::VectorXd& values, double reach)
{
    Raster raster = empty_raster(view);
    const double radius = reach / view.pixel;
    ArrayXXd nearest = ArrayXXd::Constant(view.rows, view.columns, radius * radius);
    for (Index i = 0; i < xy.cols(); ++i) {
        if (!xy.col(i).allFinite()) continue;
        const Vector2d centre = view.to_pixel(xy.col(i)) - Vector2d::Constant(0.5); // in pixel centres
        const int left = std::max(0, static_cast<int>(std::ceil(centre.x() - radius)));
        const int right = std::min(view.columns - 1, static_cast<int>(std::floor(centre.x() + radius)));
        const int top = std::max(0, static_cast<int>(std::ceil(centre.y() - radius)));
        const int bottom = std::min(view.rows - 1, static_cast<int>(std::floor(centre.y() + radius)));
        for (int column = left; column <= right; ++column)
            for (int row = top; row <= bottom; ++row) {
                const double distance2 = (Vector2d(column, row) - centre).squaredNorm();
                if (distance2 > nearest(row, column) ||
                    (distance2 == nearest(row, column) && raster.covered(row, column)))
                    continue;
                nearest(row, column) = distance2;
                raster.value(row, column) = values[i];
                raster.covered(row, column) = true;
            }
    }
    return raster;
}

Raster rasterise(const View& view, const Mesh& mesh)
{
    Raster raster = empty_raster(view);
    const Eigen::Matrix3Xi triangles = distinct(mesh.triangles);
    for (const Eigen::Vector3i& corners : triangles.colwise()) {
        Eigen::Matrix<double, 2, 3> p;
        Eigen::Vector3d z;
        for (int k = 0; k < 3; ++k) {
            p.col(k) = view.to_pixel(mesh.vertices.col(corners[k]).head<2>()) - Vector2d::Constant(0.5);
            z[k] = mesh.vertices(2, corners[k]);
        }
        Eigen::Matrix2d edges;
        edges << p.col(1) - p.col(0), p.col(2) - p.col(0);
        const double twice_area = edges.determinant();
        if (twice_area == 0 || !p.allFinite()) continue; // seen on edge
        // z over the plane of the triangle, and barycentric coordinates, are linear in the pixel.
        const Eigen::Matrix2d to_shares = edges.inverse();
        // A pixel centre on the edge of two triangles must not fall between them.
        constexpr double kEdge = 1e-9;
        const Eigen::Array2i low = p.rowwise().minCoeff().array().ceil().max(0).cast<int>();
        const Eigen::Array2i high =
            p.rowwise().maxCoeff().array().floor().min(Eigen::Array2d(view.columns - 1, view.rows - 1)).cast<int>();
        for (int column = low.x(); column <= high.x(); ++column)
            for (int row = low.y(); row <= high.y(); ++row) {
                const Vector2d share = to_shares * (Vector2d(column, row) - p.col(0));
                if (share.minCoeff() < -kEdge || share.sum() > 1 + kEdge) continue;
                const double height = z[0] + share.x() * (z[1] - z[0]) + share.y() * (z[2] - z[0]);
                double& value = raster.value(row, column);
                value = raster.covered(row, column) ? std::max(value, height) : height;
                raster.covered(row, column) = true;
            }
    }
    return raster;
}

ArrayXXd hill_shading(const Raster& heights, double pixel, double smoothing)
{
    const auto known = heights.covered && !heights.value.isNaN();
    const ArrayXXd mask = known.cast<double>();
    if (mask.sum() == 0) return ArrayXXd::Ones(mask.rows(), mask.cols());
    // What is not known takes part with weight 0; the mean is taken off so that a far z = 0 costs no digits.
    const double mean = known.select(heights.value, 0).sum() / mask.sum();
    const ArrayXXd weight = blurred(mask, smoothing);
    const ArrayXXd z = blurred(known.select(heights.value - mean, 0), smoothing) / weight.max(1e-12);

    const Eigen::Vector3d light = Eigen::Vector3d(-1, 1, 1.6).normalized(); // x right, y up
    ArrayXXd shade = ArrayXXd::Ones(z.rows(), z.cols());
    for (Index j = 1; j + 1 < z.cols(); ++j)
        for (Index i = 1; i + 1 < z.rows(); ++i) {
            if (!known(i, j) || !known(i, j - 1) || !known(i, j + 1) || !known(i - 1, j) || !known(i + 1, j)) continue;
            const double dx = (z(i, j + 1) - z(i, j - 1)) / (2 * pixel);
            const double dy = (z(i - 1, j) - z(i + 1, j)) / (2 * pixel);
            shade(i, j) = std::max(0.0, light.dot(Eigen::Vector3d(-dx, -dy, 1).normalized())) / light.z();
        }
    return shade;
}

} // namespace fettle
