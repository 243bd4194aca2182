#include "compare/cloud_reference.h"

#include "core/decompositions.h"
#include "geometry/local_quadratic.h"
#include "geometry/point_index.h"
#include "geometry/quantiles.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle::compare {

namespace {

// The quadratic has six coefficients; four points for each of them average the noise and keep the surface local.
constexpr int kNeighbours = 24;
// A foot is surrounded unless it lies near the border or in a gap: the widest angle, seen from the foot, between
// successive neighbours, and the distance of the nearest neighbour as a share of the farthest.
constexpr double kMaxGapAngle = 150 * std::numbers::pi / 180;
constexpr double kMaxNearestToFarthest = 0.6;
// In mode direction the height axis is the direction itself, unless the surface normal is more than 60° from it: a
// surface that is quadratic along the direction is then reproduced exactly.
constexpr double kMinNormalAlongDirection = 0.5;
constexpr int kRobustPasses = 3;
// The search for the foot starts at the nearest point and converges in two or three steps.
constexpr int kMaxFootSteps = 6;
// Distance of the foot from the patch's origin, as a share of its radius, within which the patch need not be refitted.
constexpr double kFootToleranceRadii = 0.05;
// A neighbour closer to the foot than this share of the radius coincides with it up to rounding: it has no direction.
constexpr double kCoincidentRadii = 1e-3;
constexpr int kMaxNewtonSteps = 20;
constexpr double kNewtonTolerance = 1e-12; // roundoff of coordinates of size 1

using Neighbourhood = Eigen::Matrix<double, 3, kNeighbours>;

/// Quadratic z = c·quadratic_terms(x, y) in a local frame whose unit of length is `radius`.
struct Patch {
    Neighbourhood neighbours;
    Eigen::Vector3d origin;
    Eigen::Matrix3d R_patch_machine; ///< rows x, y, z of the frame
    double radius = 0;               ///< mm
    bool surrounded = false;         ///< the neighbours surround the origin
    geometry::QuadraticTerms c;
    Eigen::Matrix<double, 6, 6> covariance;

    double height(const Eigen::Vector2d& xy) const { return c.dot(geometry::quadratic_terms(xy.x(), xy.y())); }
    Eigen::Vector2d slope(const Eigen::Vector2d& xy) const
    {
        return {c[1] + 2 * c[3] * xy.x() + c[4] * xy.y(), c[2] + c[4] * xy.x() + 2 * c[5] * xy.y()};
    }
    /// Point of the surface above xy, in M.
    Eigen::Vector3d point_at(const Eigen::Vector2d& xy) const
    {
        return origin + radius * (R_patch_machine.transpose() * Eigen::Vector3d(xy.x(), xy.y(), height(xy)));
    }
    /// The xy of the foot of `point`: the closest point of the surface, or its intersection along a direction.
    Eigen::Vector2d foot(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const;
    Eigen::Vector2d closest(const Eigen::Vector3d& point) const;
    Eigen::Vector2d intersection(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
};

// Least squares, then `robust_passes` re-weighted ones. Returns whether the points determine a quadratic. The sums run
// point by point: products of matrices of a fixed size of 24 are unrolled by Eigen, which takes the compiler half a
// minute.
bool fit_quadratic(Patch& patch, int robust_passes)
{
    const Neighbourhood& local = patch.neighbours;
    Eigen::Matrix<double, 6, kNeighbours> terms;
    for (int i = 0; i < kNeighbours; ++i) terms.col(i) = geometry::quadratic_terms(local(0, i), local(1, i));
    std::array<double, kNeighbours> weights, residuals, sizes;
    weights.fill(1);
    for (int pass = 0; pass <= robust_passes; ++pass) {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        geometry::QuadraticTerms right = geometry::QuadraticTerms::Zero();
        for (int i = 0; i < kNeighbours; ++i) {
            const geometry::QuadraticTerms weighted = weights[i] * terms.col(i);
            normal += weighted * terms.col(i).transpose();
            right += local(2, i) * weighted;
        }
        const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
        // A well spread neighbourhood of radius 1 has pivots near 1; rounding of float coordinates leaves 1e-7.
        constexpr double kMinPivot = 1e-7;
        if (!(solver.vectorD().minCoeff() > kMinPivot)) return false;
        patch.c = solver.solve(right);
        if (robust_passes == 0) return true;
        for (int i = 0; i < kNeighbours; ++i) {
            residuals[i] = local(2, i) - patch.c.dot(terms.col(i));
            sizes[i] = std::abs(residuals[i]);
        }
        const double sigma = geometry::kMedianToSigma * geometry::median(sizes);
        patch.covariance = sigma * sigma * solver.solve(Eigen::Matrix<double, 6, 6>::Identity());
        if (!(sigma > 0)) break;
        for (int i = 0; i < kNeighbours; ++i) {
            const double relative = residuals[i] / (geometry::kTukeyCutoff * sigma);
            weights[i] = std::abs(relative) < 1 ? std::pow(1 - relative * relative, 2) : 0;
        }
    }
    return true;
}

// Whether there are neighbours in all directions from the origin, without a gap wider than kMaxGapAngle.
bool surrounds(const Neighbourhood& local)
{
    std::vector<double> angles;
    for (int i = 0; i < kNeighbours; ++i)
        if (local.col(i).norm() > kCoincidentRadii) angles.push_back(std::atan2(local(1, i), local(0, i)));
    if (angles.empty()) return false;
    return geometry::widest_gap(angles) <= kMaxGapAngle;
}

// Newton's method from the origin, where the search has put the foot's first estimate.
Eigen::Vector2d Patch::closest(const Eigen::Vector3d& point) const
{
    Eigen::Vector2d xy(0, 0);
    Eigen::Matrix2d second;
    second << 2 * c[3], c[4], c[4], 2 * c[5];
    for (int i = 0; i < kMaxNewtonSteps; ++i) {
        const double dz = height(xy) - point.z();
        const Eigen::Vector2d tilt = slope(xy);
        const Eigen::Vector2d gradient = xy - point.head<2>() + dz * tilt;
        Eigen::Matrix2d hessian =
            Eigen::Matrix2d::Identity() + tilt * tilt.transpose(); // Gauss-Newton: always downhill
        const Eigen::Matrix2d full = hessian + dz * second;
        if (full.determinant() > 0 && full.trace() > 0) hessian = full;
        const Eigen::Vector2d step = -hessian.ldlt().solve(gradient);
        xy += step;
        if (step.norm() <= kNewtonTolerance) break;
    }
    return xy;
}

// Newton's method for the intersection of the line point + t direction with the surface, from that with the xy plane.
Eigen::Vector2d Patch::intersection(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const
{
    double t = -point.z() / direction.z();
    for (int i = 0; i < kMaxNewtonSteps; ++i) {
        const Eigen::Vector3d at = point + t * direction;
        const double rise = direction.z() - slope(at.head<2>()).dot(direction.head<2>());
        const double step = -(at.z() - height(at.head<2>())) / rise;
        t += step;
        if (!(std::abs(step) > kNewtonTolerance)) break;
    }
    return (point + t * direction).head<2>();
}

Eigen::Vector2d Patch::foot(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const
{
    const Eigen::Vector3d local = R_patch_machine * (point - origin) / radius;
    return direction ? intersection(local, R_patch_machine * *direction) : closest(local);
}

} // namespace

struct CloudReference::State {
    explicit State(const cloud::Cloud& cloud) : points(cloud.xyz), neighbours(cloud.xyz)
    {
        if (cloud::has_normals(cloud)) outward = cloud::normals(cloud);
    }

    std::optional<Patch> fit_patch(const Eigen::Vector3d& foot, const Eigen::Vector3d* direction) const;
    std::optional<Foot> find(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const;

    Eigen::Matrix3Xd points;
    Eigen::Matrix3Xd outward; ///< normals; empty if the cloud has none
    geometry::PointIndex<3> neighbours;
};

// Plain least squares fit to the neighbours of `foot`; the frame's origin is the foot projected onto their plane.
std::optional<Patch> CloudReference::State::fit_patch(const Eigen::Vector3d& foot,
                                                      const Eigen::Vector3d* direction) const
{
    const std::vector<Eigen::Index> near = neighbours.nearest(foot, kNeighbours);
    if (near.size() < kNeighbours) return std::nullopt;
    Patch patch;
    Neighbourhood& local = patch.neighbours;
    local = points(Eigen::all, near);
    const Eigen::Vector3d centroid = local.rowwise().mean();
    const Neighbourhood centred = local.colwise() - centroid;
    const core::SymmetricEigen<3> scatter = core::symmetric_eigen<3>(centred * centred.transpose());
    Eigen::Vector3d z = scatter.vectors.col(0), x = scatter.vectors.col(2);
    Eigen::Vector3d out = direction ? *direction : Eigen::Vector3d::UnitZ();
    if (!direction && outward.cols() > 0) out = outward(Eigen::all, near).rowwise().sum();
    if (z.dot(out) < 0) z = -z;
    if (direction && z.dot(*direction) >= kMinNormalAlongDirection) {
        z = *direction;
        x = z.unitOrthogonal();
    }
    patch.R_patch_machine << x.transpose(), z.cross(x).transpose(), z.transpose();
    patch.origin = foot - z.dot(foot - centroid) * z;
    local = patch.R_patch_machine * (local.colwise() - patch.origin);
    patch.radius = local.colwise().norm().maxCoeff();
    if (!(patch.radius > 0)) return std::nullopt;
    local /= patch.radius;
    patch.surrounded = local.colwise().norm().minCoeff() <= kMaxNearestToFarthest && surrounds(local);
    if (!fit_quadratic(patch, 0)) return std::nullopt;
    return patch;
}

std::optional<CloudReference::Foot> CloudReference::State::find(const Eigen::Vector3d& point,
                                                                const Eigen::Vector3d* direction) const
{
    const std::vector<Eigen::Index> first = neighbours.nearest(point, 1);
    if (first.empty()) return std::nullopt;
    Eigen::Vector3d foot = points.col(first[0]);
    if (direction) foot = point + direction->dot(foot - point) * *direction;
    std::optional<Patch> surface;
    Eigen::Vector2d xy;
    for (int step = 0; step < kMaxFootSteps; ++step) {
        surface = fit_patch(foot, direction);
        if (!surface) return std::nullopt;
        xy = surface->foot(point, direction);
        if (!xy.allFinite()) return std::nullopt;
        if (xy.norm() <= kFootToleranceRadii) break;
        foot = surface->point_at(xy);
    }
    // Only the final foot must be surrounded and lie within its patch: the first one may be a point of the border.
    if (!surface->surrounded || !fit_quadratic(*surface, kRobustPasses)) return std::nullopt;
    xy = surface->foot(point, direction);
    if (!(xy.norm() <= 1)) return std::nullopt;
    const Eigen::Vector2d slope = surface->slope(xy);
    const Eigen::Vector3d normal =
        surface->R_patch_machine.transpose() * Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    // The gradient of the height with respect to c.
    const geometry::QuadraticTerms g = geometry::quadratic_terms(xy.x(), xy.y());
    const double sigma = surface->radius * std::sqrt(g.dot(surface->covariance * g));
    foot = surface->point_at(xy);
    const Eigen::Vector3d offset = point - foot;
    const double error = direction ? direction->dot(offset) : std::copysign(offset.norm(), offset.dot(normal));
    return Foot{error, normal, foot, sigma};
}

CloudReference::CloudReference(const cloud::Cloud& cloud) : state_(std::make_unique<State>(cloud)) {}
CloudReference::CloudReference(CloudReference&&) noexcept = default;
CloudReference::~CloudReference() = default;

std::optional<CloudReference::Foot> CloudReference::closest(const Eigen::Vector3d& point) const
{
    return state_->find(point, nullptr);
}

std::optional<CloudReference::Foot> CloudReference::intersect_line(const Eigen::Vector3d& point,
                                                                   const Eigen::Vector3d& direction) const
{
    return state_->find(point, &direction);
}

} // namespace fettle::compare
