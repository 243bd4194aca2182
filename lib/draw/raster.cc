#include "draw/raster.h"

#include "draw/canvas.h"
#include "geometry/bounding_box.h"
#include "geometry/planar_grid.h"
#include "geometry/quantiles.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::draw {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// In a square grid the four nearest neighbours are one cell away; among random points the fourth is about as far away
// as a cell of their density is wide.
constexpr std::size_t kSpacingNeighbour = 4;

Raster empty_raster(const View& view)
{
    Raster raster;
    raster.value = ArrayXXd::Constant(view.rows, view.columns, std::numeric_limits<double>::quiet_NaN());
    raster.depth = raster.value;
    raster.covered.setConstant(view.rows, view.columns, false);
    return raster;
}

} // namespace

double point_spacing(const Eigen::Matrix3Xd& points)
{
    std::vector<Vector3d> positions;
    for (const Vector3d& p : points.colwise())
        if (p.head<2>().allFinite()) positions.emplace_back(p.x(), p.y(), std::isfinite(p.z()) ? p.z() : 0);
    if (positions.size() < 2) return 0;
    // Cells over the two widest sides of the box.
    const Eigen::Map<const Eigen::Matrix3Xd> all(positions[0].data(), 3, std::ssize(positions));
    const Vector3d size = geometry::bounding_box(all).sizes();
    if (!(size.maxCoeff() > 0)) return 0;
    int narrowest = 0;
    size.minCoeff(&narrowest);
    Eigen::Matrix2Xd plane(2, all.cols());
    plane << all.row(narrowest == 0 ? 1 : 0), all.row(narrowest == 2 ? 1 : 2);
    const geometry::PlanarGrid grid = geometry::planar_grid(plane, 1);
    // The median over this many points approximates that over all. Layers above each other share cells, so the fourth
    // neighbour may lie two cells away.
    constexpr Index kMinSamples = 2000;
    constexpr int kCells = 2;
    const Index step = std::max<Index>(1, all.cols() / kMinSamples);
    const double max_distance = kCells * grid.side;
    std::vector<double> spacings;
    for (Index i = 0; i < all.cols(); i += step) {
        std::array<double, kSpacingNeighbour> nearest; // ascending
        nearest.fill(max_distance);
        const Eigen::Array2d p = plane.col(i);
        geometry::visit_cells(grid, p - max_distance, p + max_distance, [&](Index k) {
            double d = (positions[grid.order[k]] - positions[i]).norm();
            if (d > 0)
                for (double& known : nearest)
                    if (d < known) std::swap(d, known);
        });
        spacings.push_back(nearest.back());
    }
    return geometry::median(spacings);
}

namespace {

/// Calls visit(row, column, squared distance in pixels) for each pixel whose centre is within `radius` pixels of a
/// point.
template <typename Visit>
void visit_pixels(const View& view, const Vector2d& point, double radius, const Visit& visit)
{
    const Vector2d centre = view.to_pixel(point) - Vector2d::Constant(0.5); // in pixel centres
    const int left = std::max(0.0, std::ceil(centre.x() - radius));
    const int right = std::min(view.columns - 1.0, std::floor(centre.x() + radius));
    const int top = std::max(0.0, std::ceil(centre.y() - radius));
    const int bottom = std::min(view.rows - 1.0, std::floor(centre.y() + radius));
    for (int column = left; column <= right; ++column)
        for (int row = top; row <= bottom; ++row)
            if (const double d2 = (Vector2d(column, row) - centre).squaredNorm(); d2 <= radius * radius)
                visit(row, column, d2);
}

/// Weight of a point at a squared distance relative to its radius: falls smoothly from 1 to a minimum above 0.
double kernel(double distance2)
{
    constexpr double kMinWeight = 1e-6;
    return (1 - distance2) * (1 - distance2) + kMinWeight;
}

} // namespace

Raster rasterise(const View& view, const Eigen::Matrix3Xd& points, const Eigen::VectorXd& values, double radius)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Raster raster = empty_raster(view);
    const double radius_pixels = radius / view.pixel;
    const auto depth_of = [&](Index i) { return std::isnan(points(2, i)) ? -kInfinity : points(2, i); };
    ArrayXXd front = ArrayXXd::Constant(view.rows, view.columns, -kInfinity);
    for (Index i = 0; i < points.cols(); ++i)
        if (points.col(i).head<2>().allFinite())
            visit_pixels(view, points.col(i).head<2>(), radius_pixels, [&](int row, int column, double) {
                front(row, column) = std::max(front(row, column), depth_of(i));
            });
    // On a surface inclined by 60° points that share a pixel lie up to two radii behind each other and are not hidden.
    constexpr double kMaxDepthRadii = 2;
    front -= kMaxDepthRadii * radius;
    ArrayXXd nearest = ArrayXXd::Constant(view.rows, view.columns, kInfinity);
    ArrayXXd weights = ArrayXXd::Zero(view.rows, view.columns), depths = weights;
    for (Index i = 0; i < points.cols(); ++i)
        if (points.col(i).head<2>().allFinite())
            visit_pixels(view, points.col(i).head<2>(), radius_pixels, [&](int row, int column, double distance2) {
                if (depth_of(i) < front(row, column)) return;
                if (std::isfinite(points(2, i))) {
                    const double weight = kernel(distance2 / (radius_pixels * radius_pixels));
                    weights(row, column) += weight;
                    depths(row, column) += weight * points(2, i);
                }
                if (!(distance2 < nearest(row, column))) return;
                nearest(row, column) = distance2;
                raster.value(row, column) = values[i];
                raster.covered(row, column) = true;
            });
    raster.depth = depths / weights; // NaN where no point has a depth
    return raster;
}

Raster rasterise(const View& view, const mesh::Mesh& mesh, const Eigen::VectorXd& values)
{
    Raster raster = empty_raster(view);
    const Eigen::Matrix3Xi triangles = mesh::unique_triangles(mesh.triangles);
    for (const Eigen::Vector3i& corners : triangles.colwise()) {
        Eigen::Matrix<double, 2, 3> p;
        Vector3d z, v;
        for (int k = 0; k < 3; ++k) {
            p.col(k) = view.to_pixel(mesh.vertices.col(corners[k]).head<2>()) - Vector2d::Constant(0.5);
            z[k] = mesh.vertices(2, corners[k]);
            v[k] = values[corners[k]];
        }
        Eigen::Matrix2d edges;
        edges << p.col(1) - p.col(0), p.col(2) - p.col(0);
        const double twice_area = edges.determinant();
        if (twice_area == 0 || !p.allFinite()) continue; // seen on edge
        // Depth and value over the plane of the triangle, and barycentric coordinates, are linear in the pixel.
        const Eigen::Matrix2d to_shares = edges.inverse();
        const auto between = [](const Vector3d& at, const Vector2d& share) {
            return at[0] + share.x() * (at[1] - at[0]) + share.y() * (at[2] - at[0]);
        };
        // A pixel centre on the common edge of two triangles must not be lost between them.
        constexpr double kBarycentricTolerance = 1e-9;
        const Eigen::Array2i low = p.rowwise().minCoeff().array().ceil().max(0).cast<int>();
        const Eigen::Array2i high =
            p.rowwise().maxCoeff().array().floor().min(Eigen::Array2d(view.columns - 1, view.rows - 1)).cast<int>();
        for (int column = low.x(); column <= high.x(); ++column)
            for (int row = low.y(); row <= high.y(); ++row) {
                const Vector2d share = to_shares * (Vector2d(column, row) - p.col(0));
                if (share.minCoeff() < -kBarycentricTolerance || share.sum() > 1 + kBarycentricTolerance) continue;
                const double depth = between(z, share);
                if (raster.covered(row, column) && depth <= raster.depth(row, column)) continue;
                raster.depth(row, column) = depth;
                raster.value(row, column) = between(v, share);
                raster.covered(row, column) = true;
            }
    }
    return raster;
}

ArrayXXd hill_shading(const Raster& raster, double pixel, double smoothing)
{
    const auto known = raster.covered && !raster.depth.isNaN();
    const ArrayXXd mask = known.cast<double>();
    if (mask.sum() == 0) return ArrayXXd::Ones(mask.rows(), mask.cols());
    // Undefined pixels have weight 0. The mean is subtracted so that a large offset of z costs no digits.
    const double mean = known.select(raster.depth, 0).sum() / mask.sum();
    const ArrayXXd weight = gaussian_blur(mask, smoothing);
    const ArrayXXd z = gaussian_blur(known.select(raster.depth - mean, 0), smoothing) / weight.max(1e-12);

    const Vector3d light = Vector3d(-1, 1, 1.6).normalized(); // in V
    ArrayXXd shade = ArrayXXd::Ones(z.rows(), z.cols());
    for (Index j = 1; j + 1 < z.cols(); ++j)
        for (Index i = 1; i + 1 < z.rows(); ++i) {
            if (!known(i, j) || !known(i, j - 1) || !known(i, j + 1) || !known(i - 1, j) || !known(i + 1, j)) continue;
            const double dx = (z(i, j + 1) - z(i, j - 1)) / (2 * pixel);
            const double dy = (z(i - 1, j) - z(i + 1, j)) / (2 * pixel);
            shade(i, j) = std::max(0.0, light.dot(Vector3d(-dx, -dy, 1).normalized())) / light.z();
        }
    return shade;
}

} // namespace fettle::draw
