#include "compare/raster.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of a square grid these are all one cell away; of points at random the fourth is about as far as cells of their
// density are wide.
constexpr std::size_t kNeighbours = 4;

Raster empty_raster(const View& view)
{
    Raster raster;
    raster.value = ArrayXXd::Constant(view.rows, view.columns, std::numeric_limits<double>::quiet_NaN());
    raster.depth = raster.value;
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

double point_spacing(const Eigen::Matrix3Xd& points)
{
    std::vector<Vector3d> places;
    for (const Vector3d& p : points.colwise())
        if (p.head<2>().allFinite()) places.emplace_back(p.x(), p.y(), std::isfinite(p.z()) ? p.z() : 0);
    if (places.size() < 2) return 0;
    Vector3d least = places[0], most = places[0];
    for (const Vector3d& p : places) {
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
    }
    // Buckets over the two widest sides of the box, of about one point each; a line of points has no area.
    int narrowest = 0;
    (most - least).minCoeff(&narrowest);
    const int u = narrowest == 0 ? 1 : 0, v = narrowest == 2 ? 1 : 2;
    const Vector2d size(most[u] - least[u], most[v] - least[v]);
    const double share =
        std::max(std::sqrt(size.prod() / double(places.size())), size.maxCoeff() / double(places.size()));
    if (!(share > 0)) return 0;
    const Eigen::Array2i count = (size.array() / share).cast<int>() + 1;
    const auto bucket_of = [&](const Vector3d& p) -> Eigen::Array2i {
        return (Eigen::Array2d(p[u] - least[u], p[v] - least[v]) / share).cast<int>();
    };
    std::vector<int> first(static_cast<std::size_t>(count.prod()), -1), next(places.size(), -1);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Eigen::Array2i b = bucket_of(places[i]);
        int& head = first[static_cast<std::size_t>(b.y() * count.x() + b.x())];
        next[i] = head;
        head = static_cast<int>(i);
    }
    // The median over so many points is near enough to that over all. Layers over one another share buckets, so the
    // ones that are sought may lie two buckets away.
    constexpr std::size_t kProbed = 2000;
    constexpr int kAway = 2;
    const std::size_t step = std::max<std::size_t>(1, places.size() / kProbed);
    std::vector<double> spacings;
    for (std::size_t i = 0; i < places.size(); i += step) {
        const Eigen::Array2i b = bucket_of(places[i]);
        std::array<double, kNeighbours> nearest; // ascending
        nearest.fill(kAway * share);
        for (int y = std::max(0, b.y() - kAway); y <= std::min(count.y() - 1, b.y() + kAway); ++y)
            for (int x = std::max(0, b.x() - kAway); x <= std::min(count.x() - 1, b.x() + kAway); ++x)
                for (int k = first[static_cast<std::size_t>(y * count.x() + x)]; k >= 0;
                     k = next[static_cast<std::size_t>(k)]) {
                    double d = (places[static_cast<std::size_t>(k)] - places[i]).norm();
                    if (d > 0)
                        for (double& known : nearest)
                            if (d < known) std::swap(d, known);
                }
        spacings.push_back(nearest.back());
    }
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::nth_element(spacings.begin(), middle, spacings.end());
    return *middle;
}

namespace {

/// Calls visit(row, column, squared distance in pixels) for each pixel whose centre is within `radius` pixels of a
/// point.
template <typename Visit>
void each_pixel_near(const View& view, const Vector2d& point, double radius, const Visit& visit)
{
    const Vector2d centre = view.to_pixel(point) - Vector2d::Constant(0.5); // in pixel centres
    const int left = std::max(0, static_cast<int>(std::ceil(centre.x() - radius)));
    const int right = std::min(view.columns - 1, static_cast<int>(std::floor(centre.x() + radius)));
    const int top = std::max(0, static_cast<int>(std::ceil(centre.y() - radius)));
    const int bottom = std::min(view.rows - 1, static_cast<int>(std::floor(centre.y() + radius)));
    for (int column = left; column <= right; ++column)
        for (int row = top; row <= bottom; ++row)
            if (const double d2 = (Vector2d(column, row) - centre).squaredNorm(); d2 <= radius * radius)
                visit(row, column, d2);
}

/// How much a point counts at a squared distance, as a share of its reach: smoothly down to nothing, but not to 0.
double kernel(double distance2)
{
    constexpr double kLeast = 1e-6;
    return (1 - distance2) * (1 - distance2) + kLeast;
}

} // namespace

Raster rasterise(const View& view, const Eigen::Matrix3Xd& points, const Eigen::VectorXd& values, double reach)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Raster raster = empty_raster(view);
    const double radius = reach / view.pixel;
    const auto depth_of = [&](Index i) { return std::isnan(points(2, i)) ? -kInfinity : points(2, i); };
    ArrayXXd front = ArrayXXd::Constant(view.rows, view.columns, -kInfinity);
    for (Index i = 0; i < points.cols(); ++i)
        if (points.col(i).head<2>().allFinite())
            each_pixel_near(view, points.col(i).head<2>(), radius, [&](int row, int column, double) {
                front(row, column) = std::max(front(row, column), depth_of(i));
            });
    // Of a surface that leans by 60° the points that share a pixel lie up to twice their reach behind one another.
    constexpr double kBehind = 2;
    front -= kBehind * reach;
    ArrayXXd nearest = ArrayXXd::Constant(view.rows, view.columns, kInfinity);
    ArrayXXd weights = ArrayXXd::Zero(view.rows, view.columns), depths = weights;
    for (Index i = 0; i < points.cols(); ++i)
        if (points.col(i).head<2>().allFinite())
            each_pixel_near(view, points.col(i).head<2>(), radius, [&](int row, int column, double distance2) {
                if (depth_of(i) < front(row, column)) return;
                if (std::isfinite(points(2, i))) {
                    const double weight = kernel(distance2 / (radius * radius));
                    weights(row, column) += weight;
                    depths(row, column) += weight * points(2, i);
                }
                if (!(distance2 < nearest(row, column))) return;
                nearest(row, column) = distance2;
                raster.value(row, column) = values[i];
                raster.covered(row, column) = true;
            });
    raster.depth = depths / weights; // NaN where none is known
    return raster;
}

Raster rasterise(const View& view, const Mesh& mesh, const Eigen::VectorXd& values)
{
    Raster raster = empty_raster(view);
    const Eigen::Matrix3Xi triangles = distinct(mesh.triangles);
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
        // A pixel centre on the edge of two triangles must not fall between them.
        constexpr double kEdge = 1e-9;
        const Eigen::Array2i low = p.rowwise().minCoeff().array().ceil().max(0).cast<int>();
        const Eigen::Array2i high =
            p.rowwise().maxCoeff().array().floor().min(Eigen::Array2d(view.columns - 1, view.rows - 1)).cast<int>();
        for (int column = low.x(); column <= high.x(); ++column)
            for (int row = low.y(); row <= high.y(); ++row) {
                const Vector2d share = to_shares * (Vector2d(column, row) - p.col(0));
                if (share.minCoeff() < -kEdge || share.sum() > 1 + kEdge) continue;
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
    // What is not known takes part with weight 0; the mean is taken off so that a far z = 0 costs no digits.
    const double mean = known.select(raster.depth, 0).sum() / mask.sum();
    const ArrayXXd weight = blurred(mask, smoothing);
    const ArrayXXd z = blurred(known.select(raster.depth - mean, 0), smoothing) / weight.max(1e-12);

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

} // namespace fettle
