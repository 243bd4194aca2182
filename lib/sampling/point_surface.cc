#include "sampling/point_surface.h"

#include "geometry/local_quadratic.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::sampling {

namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kFitRadiusSpacings = 3; // radius of the local quadratic: about 28 points of a regular scan

// Neighbours for the estimate of the spacing. Among so many, a scan whose lines are five times as far apart as the
// points on them still has points of several lines.
constexpr Index kNeighbours = 16;
constexpr Index kSpacingSamples = 1000; // a median of so many is exact to a few per cent

constexpr double kPointsPerCell = 4;

// The points must surround the vertical line: no empty sector of half a circle or more.
constexpr double kMaxEmptySector = std::numbers::pi;

// A larger gap in z separates two sheets. Successive heights of a sheet at 45 degrees differ by less than a spacing.
constexpr double kSheetGapSpacings = 3;

// Residuals above so many standard deviations, estimated by the median, are outliers.
constexpr double kOutlierSigmas = 4;
constexpr int kMaxReweightings = 12; // towards least absolute deviations: enough for three digits

// Smaller residuals are roundoff of float coordinates, not noise.
constexpr double kRoundoffSpacings = 1e-6;

constexpr Index kUnknowns = geometry::QuadraticTerms::SizeAtCompileTime;

/// Minimum of a squared pivot relative to the diagonal: the share of a term that the terms before it do not explain.
/// Points on one line or circle do not determine a quadratic. The bound is the square of 1e-6, the rounding of float
/// coordinates.
constexpr double kMinPivotShare = 1e-12;

bool surrounded(const Points& points, const Vector2d& xy)
{
    std::vector<double> angles;
    for (const Vector3d& point : points) {
        const Vector2d from = point.head<2>() - xy;
        if (from.isZero(0)) return true; // a point on the line itself
        angles.push_back(std::atan2(from.y(), from.x()));
    }
    return geometry::widest_gap(angles) < kMaxEmptySector;
}

// Weight of a point by its distance in radii of the fit: tricube, as of local regression (Cleveland 1979). With equal
// weights the quadratic at the foot of a wall would dip below all points near it.
double distance_weight(double distance)
{
    const double rest = std::max(1 - distance * distance * distance, 0.0);
    return rest * rest * rest;
}

// z of the local quadratic at its origin xy. Iteratively reweighted least squares, towards least absolute deviations,
// detects the outliers; the others then have the weights of their distance. Normal equations suffice: within 3 spacings
// the terms have about the same size, and all solutions but the last only give weights.
std::optional<double> robust_height(const Points& points, const Vector2d& xy, double spacing)
{
    const Index n = points.size();
    Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> terms(kUnknowns, n);
    Eigen::ArrayXd z(n), residuals(n), near(n);
    for (Index i = 0; i < n; ++i) {
        const Vector3d& point = points[i];
        const Vector2d uv = (point.head<2>() - xy) / (kFitRadiusSpacings * spacing);
        terms.col(i) = geometry::quadratic_terms(uv.x(), uv.y());
        near[i] = distance_weight(uv.norm());
        z[i] = point.z();
    }
    // Between points on both sides of a wall the quadratic may be an extrapolation. A height outside of their range by
    // more than the radius of the fit is no surface.
    const double reach = kFitRadiusSpacings * spacing, lowest = z.minCoeff() - reach, highest = z.maxCoeff() + reach;
    const double middle = z.mean(); // subtracted, so that no digits are lost far from z = 0
    z -= middle;
    Eigen::ArrayXd weights = near;
    geometry::QuadraticTerms coefficients;
    const auto solve = [&] {
        geometry::QuadraticEquations<1> equations;
        for (Index i = 0; i < n; ++i) equations.add_point(terms.col(i), Eigen::Matrix<double, 1, 1>(z[i]), weights[i]);
        const auto fit = equations.solve();
        if (!fit) return false;
        const auto min_squares = kMinPivotShare * equations.A.diagonal().array();
        if (!(fit->pivots.array().square() > min_squares).all()) return false;
        coefficients = fit->coefficients;
        residuals = ((coefficients.transpose() * terms).transpose().array() - z).abs();
        return true;
    };
    for (int step = 0; step < kMaxReweightings; ++step) {
        if (!solve()) return std::nullopt;
        if (residuals.maxCoeff() <= kRoundoffSpacings * spacing) break; // no outliers
        weights =
            near *
            residuals.max(std::max(kRoundoffSpacings * spacing, kRoundoffSpacings * residuals.maxCoeff())).inverse();
    }
    const double limit = std::max(kOutlierSigmas * geometry::kMedianToSigma * geometry::median_absolute(residuals),
                                  kRoundoffSpacings * spacing);
    weights = near * (residuals <= limit).cast<double>();
    if ((weights > 0).count() < kUnknowns || !solve()) return std::nullopt;
    const double height = middle + coefficients[0];
    return height >= lowest && height <= highest ? std::optional(height) : std::nullopt;
}

// The points of the highest sheet that surrounds the vertical line; empty if there is none.
Points highest_sheet(Points points, const Vector2d& xy, double spacing)
{
    std::sort(points.begin(), points.end(), [](const Vector3d& a, const Vector3d& b) { return a.z() > b.z(); });
    Points sheet;
    for (std::size_t i = 0; i < points.size(); ++i) {
        sheet.push_back(points[i]);
        const bool ends = i + 1 == points.size() || points[i].z() - points[i + 1].z() > kSheetGapSpacings * spacing;
        if (!ends) continue;
        if (std::ssize(sheet) >= kUnknowns && surrounded(sheet, xy)) return sheet;
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
    if (kept.empty()) return;
    const Eigen::Matrix3Xd all = points(Eigen::all, kept);
    grid_ = geometry::planar_grid(all.topRows<2>(), kPointsPerCell);
    points_ = all(Eigen::all, grid_.order);
    spacing_ = median_spacing();
}

Points PointSurface::points_within(const Vector2d& xy, double radius) const
{
    Points found;
    if (points_.cols() == 0) return found;
    geometry::visit_cells(grid_, xy.array() - radius, xy.array() + radius, [&](Index i) {
        if ((points_.col(i).head<2>() - xy).squaredNorm() <= radius * radius) found.push_back(points_.col(i));
    });
    return found;
}

double PointSurface::median_spacing() const
{
    const Index n = points_.cols();
    const Index k = std::min(kNeighbours, n - 1);
    if (k == 0) return 0;
    const Index step = std::max<Index>(1, n / kSpacingSamples);
    std::vector<double> spacings;
    for (Index i = 0; i < n; i += step) {
        std::vector<double> distances;
        // Distances in space, because on a steep flank points are close together in plan view.
        for (double radius = grid_.side;; radius *= 2) {
            distances.clear();
            for (const Vector3d& point : points_within(points_.col(i).head<2>(), radius)) {
                const double d = (point - points_.col(i)).norm();
                if (d <= radius) distances.push_back(d);
            }
            const Index count = distances.size(); // the point itself is counted
            if (count > k || count == n) break;
        }
        const auto kth = distances.begin() + std::min<std::size_t>(k, distances.size() - 1);
        std::nth_element(distances.begin(), kth, distances.end());
        spacings.push_back(*kth * std::sqrt(std::numbers::pi / static_cast<double>(k)));
    }
    return geometry::median(spacings);
}

std::optional<double> PointSurface::height(const Vector2d& xy) const
{
    if (!(spacing_ > 0)) return std::nullopt;
    const Points sheet = highest_sheet(points_within(xy, kFitRadiusSpacings * spacing_), xy, spacing_);
    if (sheet.empty()) return std::nullopt;
    return robust_height(sheet, xy, spacing_);
}

std::optional<double> PointSurface::highest(const Eigen::Vector2d& xy, double radius) const
{
    std::optional<double> z;
    for (const Eigen::Vector3d& point : points_within(xy, radius)) z = std::max(z.value_or(point.z()), point.z());
    return z;
}

// The ball's lowest point is at the maximum of z(q) + sqrt(R^2 - |q - xy|^2) - R over the disc |q - xy| <= R: a search
// over a square lattice, then a pattern search whose steps are halved.
std::optional<double> PointSurface::drop_ball(const Vector2d& xy, double radius) const
{
    constexpr int kHalfLattice = 8;   // a bump narrower than an eighth of the radius may be missed
    constexpr double kMinStep = 1e-6; // relative to the radius; the error of the height is of second order
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
    for (; lowest && step > kMinStep * radius; step /= 2)
        for (bool moved = true; moved;) {
            moved = false;
            const Vector2d from = best;
            for (const Vector2d& direction : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)})
                moved |= try_at(from + step * direction);
        }
    return lowest;
}

} // namespace fettle::sampling
