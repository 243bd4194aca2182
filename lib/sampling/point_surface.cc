#include "sampling/point_surface.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kNearSpacings = 3; // of the points that the local quadratic is fitted to: some 28 on a regular scan

// Points for the estimate of the spacing: so many around each that a scan of lines five times as far apart as the
// points on them still counts several lines.
constexpr Index kNeighbours = 16;
constexpr Index kProbedForSpacing = 1000; // a median of so many is exact to a few per cent

constexpr double kPointsPerCell = 4;

// The points must surround the line: no empty sector of half a circle or more.
constexpr double kWidestSector = std::numbers::pi;

// Two sheets are told apart by a gap in z; on one sheet of 45 degrees, heights follow each other within a spacing.
constexpr double kSheetGapSpacings = 3;

// Points farther from the quadratic than that many standard deviations are outliers (as estimated by the median).
constexpr double kOutlierSigmas = 4;
constexpr double kSigmaPerMedian = 1.4826; // of the absolute deviations of a normal distribution
constexpr int kMedianSteps = 12;           // of reweighting towards least absolute deviations: enough for three digits

// Below that share of the spacing residuals are roundoff of float coordinates, not noise.
constexpr double kExact = 1e-6;

constexpr int kUnknowns = 6;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// Of a term's square, what the terms before it do not explain must be more than this share: the points may lie on one
/// line or a circle, where a quadratic is not determined. A millionth of the length, as float coordinates are rounded.
constexpr double kIndependent = 1e-12;

Unknowns quadratic(double u, double v) { return (Unknowns() << 1, u, v, u * u, u * v, v * v).finished(); }

bool surrounded(const Points& points, const Vector2d& xy)
{
    std::vector<double> angles;
    for (const Vector3d& point : points) {
        const Vector2d from = point.head<2>() - xy;
        if (from.isZero(0)) return true; // measured right there
        angles.push_back(std::atan2(from.y(), from.x()));
    }
    std::sort(angles.begin(), angles.end());
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
    return widest < kWidestSector;
}

double median(Eigen::VectorXd values)
{
    const Index middle = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + middle, values.end());
    return values[middle];
}

// z of the quadratic at its origin xy. Least absolute deviations by reweighting show which points are outliers; the
// others then count alike. By normal equations: within 3 spacings the terms are of one size, and only the last of the
// solutions is more than weights for the next.
std::optional<double> robust_height(const Points& points, const Vector2d& xy, double spacing)
{
    const Index n = static_cast<Index>(points.size());
    Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> terms(kUnknowns, n);
    Eigen::ArrayXd z(n), residuals(n), weights = Eigen::ArrayXd::Ones(n);
    for (Index i = 0; i < n; ++i) {
        const Vector3d& point = points[static_cast<std::size_t>(i)];
        const Vector2d uv = (point.head<2>() - xy) / (kNearSpacings * spacing);
        terms.col(i) = quadratic(uv.x(), uv.y());
        z[i] = point.z();
    }
    const double middle = z.mean(); // far from z = 0 digits would be lost
    z -= middle;
    Unknowns coefficients;
    const auto solve = [&] {
        Normal A = Normal::Zero();
        Unknowns b = Unknowns::Zero();
        for (Index i = 0; i < n; ++i) {
            const Unknowns weighted = weights[i] * terms.col(i);
            A.noalias() += weighted * terms.col(i).transpose();
            b += weighted * z[i];
        }
        const Eigen::LLT<Normal> cholesky(A);
        const Unknowns pivots = cholesky.matrixLLT().diagonal();
        const auto independent = pivots.array().square() > kIndependent * A.diagonal().array();
        if (cholesky.info() != Eigen::Success || !independent.all()) return false;
        coefficients = cholesky.solve(b);
        residuals = ((coefficients.transpose() * terms).transpose().array() - z).abs();
        return true;
    };
    for (int step = 0; step < kMedianSteps; ++step) {
        if (!solve()) return std::nullopt;
        if (residuals.maxCoeff() <= kExact * spacing) break; // without an outlier
        weights = residuals.max(std::max(kExact * spacing, kExact * residuals.maxCoeff())).inverse();
    }
    const double limit = std::max(kOutlierSigmas * kSigmaPerMedian * median(residuals), kExact * spacing);
    weights = (residuals <= limit).cast<double>();
    if (weights.sum() < kUnknowns || !solve()) return std::nullopt;
    return middle + coefficients[0];
}

// The points of the highest sheet that surrounds the line; none if no sheet does.
Points highest_sheet(Points points, const Vector2d& xy, double spacing)
{
    std::sort(points.begin(), points.end(), [](const Vector3d& a, const Vector3d& b) { return a.z() > b.z(); });
    Points sheet;
    for (std::size_t i = 0; i < points.size(); ++i) {
        sheet.push_back(points[i]);
        const bool ends = i + 1 == points.size() || points[i].z() - points[i + 1].z() > kSheetGapSpacings * spacing;
        if (!ends) continue;
        if (sheet.size() >= std::size_t{kUnknowns} && surrounded(sheet, xy)) return sheet;
        sheet.clear();
    }
    return sheet;
}

} // namespace

PointSurface::PointSurface(const Eigen::Matrix3Xd& points)
{
    std::vector<Index> kept;
    for (Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) kept.push_back(i);
    if (kept.empty()) {
        size_.setZero();
        return;
    }
    const Eigen::Matrix3Xd all = points(Eigen::all, kept);
    const Index n = all.cols();
    origin_ = all.topRows<2>().rowwise().minCoeff();
    const Vector2d extent = all.topRows<2>().rowwise().maxCoeff() - origin_;
    const double longest = std::max(extent.maxCoeff(), std::numeric_limits<double>::min());
    cell_ = std::max(std::sqrt(extent.prod() * kPointsPerCell / static_cast<double>(n)),
                     longest * kPointsPerCell / static_cast<double>(n));
    size_ = (extent / cell_).array().floor().cast<int>() + 1;

    std::vector<Index> cells(static_cast<std::size_t>(n)), order(static_cast<std::size_t>(n));
    start_.assign(static_cast<std::size_t>(size_.x()) * size_.y() + 1, 0);
    for (Index i = 0; i < n; ++i) {
        const Eigen::Array2i cell =
            ((all.col(i).head<2>() - origin_) / cell_).array().floor().cast<int>().min(size_.array() - 1);
        cells[static_cast<std::size_t>(i)] = static_cast<Index>(cell.y()) * size_.x() + cell.x();
        ++start_[static_cast<std::size_t>(cells[static_cast<std::size_t>(i)]) + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
        return cells[static_cast<std::size_t>(a)] < cells[static_cast<std::size_t>(b)];
    });
    points_ = all(Eigen::all, order);
    spacing_ = density_spacing();
}

Points PointSurface::near(const Vector2d& xy, double radius) const
{
    Points found;
    const auto cell = [&](double x, double least, int size) {
        return static_cast<int>(std::clamp(std::floor((x - least) / cell_), 0.0, size - 1.0));
    };
    if (size_.minCoeff() == 0) return found;
    const int from_x = cell(xy.x() - radius, origin_.x(), size_.x()),
              to_x = cell(xy.x() + radius, origin_.x(), size_.x());
    const int from_y = cell(xy.y() - radius, origin_.y(), size_.y()),
              to_y = cell(xy.y() + radius, origin_.y(), size_.y());
    for (int y = from_y; y <= to_y; ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * size_.x();
        for (Index i = start_[row + from_x]; i < start_[row + to_x + 1]; ++i)
            if ((points_.col(i).head<2>() - xy).squaredNorm() <= radius * radius) found.push_back(points_.col(i));
    }
    return found;
}

double PointSurface::density_spacing() const
{
    const Index n = points_.cols();
    const Index k = std::min(kNeighbours, n - 1);
    if (k == 0) return 0;
    const Index step = std::max<Index>(1, n / kProbedForSpacing);
    std::vector<double> spacings;
    for (Index i = 0; i < n; i += step) {
        std::vector<double> distances;
        // distances in space: on a steep flank points lie close together seen from above
        for (double radius = cell_;; radius *= 2) {
            distances.clear();
            for (const Vector3d& point : near(points_.col(i).head<2>(), radius)) {
                const double d = (point - points_.col(i)).norm();
                if (d <= radius) distances.push_back(d);
            }
            if (static_cast<Index>(distances.size()) > k) break; // the point itself is among them
            if (static_cast<Index>(distances.size()) == n) break;
        }
        const auto kth =
            distances.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(k, distances.size() - 1));
        std::nth_element(distances.begin(), kth, distances.end());
        spacings.push_back(*kth * std::sqrt(std::numbers::pi / static_cast<double>(k)));
    }
    return median(Eigen::Map<Eigen::VectorXd>(spacings.data(), static_cast<Index>(spacings.size())));
}

std::optional<double> PointSurface::height(const Vector2d& xy) const
{
    if (!(spacing_ > 0)) return std::nullopt;
    const Points sheet = highest_sheet(near(xy, kNearSpacings * spacing_), xy, spacing_);
    if (sheet.empty()) return std::nullopt;
    return robust_height(sheet, xy, spacing_);
}

std::optional<double> PointSurface::highest(const Eigen::Vector2d& xy, double radius) const
{
    std::optional<double> z;
    for (const Eigen::Vector3d& point : near(xy, radius)) z = std::max(z.value_or(point.z()), point.z());
    return z;
}

// The ball's lowest point is at the largest z(q) + sqrt(R^2 - |q - xy|^2) - R over the disc of its shadow: found on a
// square lattice first, then by steps that are halved.
std::optional<double> PointSurface::drop_ball(const Vector2d& xy, double radius) const
{
    constexpr int kHalfLattice = 8;    // a bump narrower than an eighth of the radius may be missed
    constexpr double kLastStep = 1e-6; // of the radius: the height is then exact to its square
    if (!(spacing_ > 0)) return std::nullopt;

    Vector2d best = xy;
    std::optional<double> lowest;
    const auto try_at = [&](const Vector2d& q) {
        const double root = radius * radius - (q - xy).squaredNorm();
        const std::optional<double> z = root >= 0 ? height(q) : std::nullopt;
        if (!z || (lowest && *z + std::sqrt(root) - radius <= *lowest)) return false;
        lowest = *z + std::sqrt(root) - radius;
        best = q;
        return true;
    };
    double step = std::max(spacing_, radius / kHalfLattice);
    const int half = static_cast<int>(radius / step);
    for (int j = -half; j <= half; ++j)
        for (int i = -half; i <= half; ++i) try_at(xy + step * Vector2d(i, j));
    for (; lowest && step > kLastStep * radius; step /= 2)
        for (bool moved = true; moved;) {
            moved = false;
            const Vector2d from = best;
            for (const Vector2d& way : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)})
                moved |= try_at(from + step * way);
        }
    return lowest;
}

} // namespace fettle
