#include "compare/cloud_reference.h"

#include "cloud/neighbours.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle {

namespace {

// The quadratic has six coefficients; four points for each of them average the noise and keep the surface local.
constexpr Eigen::Index kNeighbours = 24;
// Nearer to the border than half of the surroundings, or in a gap as wide as the neighbourhood, nothing surrounds the
// foot: the widest angle without a neighbour, and the nearest one as a share of the farthest.
constexpr double kWidestGap = 170 * std::numbers::pi / 180;
constexpr double kNearest = 0.6;
// Tukey's biweight at 95 % efficiency for normal noise, and the factor from the median |residual| to sigma.
constexpr double kTukey = 4.685;
constexpr double kMedianToSigma = 1.4826;
constexpr int kRobustPasses = 3;
// The foot moves by the curvature over the way from the first neighbour: it settles in two or three steps.
constexpr int kFootSteps = 6;
constexpr double kSettled = 1e-3; // share of the neighbourhood's radius that a foot may still move
constexpr int kNewton = 20;

using Quadratic = Eigen::Matrix<double, 6, 1>;

Quadratic terms(double x, double y) { return {1, x, y, x * x, x * y, y * y}; }

/// z = c·terms(x, y) in a frame of its own; lengths are shares of `radius`.
struct Patch {
    Eigen::Vector3d origin;
    Eigen::Matrix3d R_patch_machine; ///< rows x, y, z of the frame
    double radius = 0;
    bool covered = false; ///< do the neighbours surround the origin?
    Quadratic c;
    Eigen::Matrix<double, 6, 6> covariance;

    double height(const Eigen::Vector2d& xy) const { return c.dot(terms(xy.x(), xy.y())); }
    Eigen::Vector2d slope(const Eigen::Vector2d& xy) const
    {
        return {c[1] + 2 * c[3] * xy.x() + c[4] * xy.y(), c[2] + c[4] * xy.x() + 2 * c[5] * xy.y()};
    }
};

double median_of(std::array<double, kNeighbours> values)
{
    std::nth_element(values.begin(), values.begin() + kNeighbours / 2, values.end());
    return values[kNeighbours / 2];
}

using Local = Eigen::Matrix<double, 3, kNeighbours>;

// Robust least squares by re-weighting. False if the points do not determine a quadratic.
bool fit_quadratic(const Local& local, Patch& patch)
{
    Eigen::Matrix<double, kNeighbours, 6> A;
    for (Eigen::Index i = 0; i < kNeighbours; ++i) A.row(i) = terms(local(0, i), local(1, i)).transpose();
    const Eigen::Matrix<double, kNeighbours, 1> z = local.row(2).transpose();
    Eigen::Matrix<double, kNeighbours, 1> weight = Eigen::Matrix<double, kNeighbours, 1>::Ones();
    for (int pass = 0; pass <= kRobustPasses; ++pass) {
        const Eigen::Matrix<double, 6, 6> normal = A.transpose() * weight.asDiagonal() * A;
        const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
        // In shares of the radius a well spread neighbourhood has pivots near 1; float coordinates leave 1e-7.
        constexpr double kLeastPivot = 1e-7;
        if (!(solver.vectorD().minCoeff() > kLeastPivot)) return false;
        patch.c = solver.solve(A.transpose() * (weight.asDiagonal() * z));
        const Eigen::Matrix<double, kNeighbours, 1> residual = z - A * patch.c;
        std::array<double, kNeighbours> size;
        for (Eigen::Index i = 0; i < kNeighbours; ++i) size[static_cast<std::size_t>(i)] = std::abs(residual[i]);
        const double sigma = kMedianToSigma * median_of(size);
        patch.covariance = sigma * sigma * solver.solve(Eigen::Matrix<double, 6, 6>::Identity());
        if (!(sigma > 0)) break;
        const auto share = (residual.array() / (kTukey * sigma)).square();
        weight = (share < 1).select((1 - share).square(), 0);
    }
    return true;
}

// Does every half plane (nearly) about the origin hold a neighbour?
bool surrounds(const Local& local)
{
    std::array<double, kNeighbours> angle;
    for (Eigen::Index i = 0; i < kNeighbours; ++i)
        angle[static_cast<std::size_t>(i)] = std::atan2(local(1, i), local(0, i));
    std::sort(angle.begin(), angle.end());
    double widest = angle.front() + 2 * std::numbers::pi - angle.back();
    for (std::size_t i = 1; i < angle.size(); ++i) widest = std::max(widest, angle[i] - angle[i - 1]);
    return widest <= kWidestGap;
}

// Closest point of z = q(x, y) to `point`, by Newton from below it; lengths are shares of the radius.
Eigen::Vector2d closest_on(const Patch& patch, const Eigen::Vector3d& point)
{
    Eigen::Vector2d xy(0, 0);
    Eigen::Matrix2d second;
    second << 2 * patch.c[3], patch.c[4], patch.c[4], 2 * patch.c[5];
    for (int i = 0; i < kNewton; ++i) {
        const double below = patch.height(xy) - point.z();
        const Eigen::Vector2d slope = patch.slope(xy);
        const Eigen::Vector2d gradient = xy - point.head<2>() + below * slope;
        Eigen::Matrix2d hessian = Eigen::Matrix2d::Identity() + slope * slope.transpose();
        const Eigen::Matrix2d full = hessian + below * second;
        if (full.determinant() > 0 && full.trace() > 0) hessian = full; // else Gauss-Newton's, always downhill
        const Eigen::Vector2d step = -hessian.ldlt().solve(gradient);
        xy += step;
        if (step.norm() <= 1e-12) break; // roundoff of coordinates of size 1
    }
    return xy;
}

// Where the line point + t direction meets z = q(x, y); from its crossing with the frame's plane.
Eigen::Vector2d crossing(const Patch& patch, const Eigen::Vector3d& point, const Eigen::Vector3d& direction)
{
    double t = -point.z() / direction.z();
    for (int i = 0; i < kNewton; ++i) {
        const Eigen::Vector3d at = point + t * direction;
        const double rise = direction.z() - patch.slope(at.head<2>()).dot(direction.head<2>());
        const double step = -(at.z() - patch.height(at.head<2>())) / rise;
        t += step;
        if (!(std::abs(step) > 1e-12)) break; // roundoff of coordinates of size 1
    }
    return (point + t * direction).head<2>();
}

} // namespace

struct CloudReference::State {
    explicit State(const Cloud& cloud) : points(cloud.xyz), neighbours(cloud.xyz)
    {
        if (has_normals(cloud)) outward = normals(cloud);
    }

    std::optional<Patch> patch(const Eigen::Vector3d& foot, const Eigen::Vector3d& up) const;
    std::optional<Foot> find(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const;

    Eigen::Matrix3Xd points;
    Eigen::Matrix3Xd outward; ///< empty: no normals
    Neighbours neighbours;
};

// The surface about `foot`, with the frame's origin there. @param up  on whose side z is if the cloud has no normals
std::optional<Patch> CloudReference::State::patch(const Eigen::Vector3d& foot, const Eigen::Vector3d& up) const
{
    const std::vector<Eigen::Index> near = neighbours.nearest(foot, kNeighbours);
    if (static_cast<Eigen::Index>(near.size()) < kNeighbours) return std::nullopt;
    Local local = points(Eigen::all, near);
    const Eigen::Vector3d centroid = local.rowwise().mean();
    const Local about = local.colwise() - centroid;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(about * about.transpose());
    Patch patch;
    Eigen::Vector3d z = spread.eigenvectors().col(0);
    const Eigen::Vector3d x = spread.eigenvectors().col(2);
    const Eigen::Vector3d out = outward.cols() > 0 ? Eigen::Vector3d(outward(Eigen::all, near).rowwise().sum()) : up;
    if (z.dot(out) < 0) z = -z;
    patch.R_patch_machine << x.transpose(), z.cross(x).transpose(), z.transpose();
    patch.origin = foot - z.dot(foot - centroid) * z;
    local = patch.R_patch_machine * (local.colwise() - patch.origin);
    patch.radius = local.colwise().norm().maxCoeff();
    if (!(patch.radius > 0)) return std::nullopt;
    local /= patch.radius;
    patch.covered = local.colwise().norm().minCoeff() <= kNearest && surrounds(local);
    if (!fit_quadratic(local, patch)) return std::nullopt;
    return patch;
}

std::optional<CloudReference::Foot> CloudReference::State::find(const Eigen::Vector3d& point,
                                                                const Eigen::Vector3d* direction) const
{
    const std::vector<Eigen::Index> first = neighbours.nearest(point, 1);
    if (first.empty()) return std::nullopt;
    const Eigen::Vector3d up = direction ? *direction : Eigen::Vector3d::UnitZ();
    Eigen::Vector3d foot = points.col(first[0]);
    if (direction) foot = point + direction->dot(foot - point) * *direction;
    for (int step = 0; step < kFootSteps; ++step) {
        const std::optional<Patch> surface = patch(foot, up);
        if (!surface) return std::nullopt;
        const Eigen::Vector3d p = surface->R_patch_machine * (point - surface->origin) / surface->radius;
        const Eigen::Vector2d xy =
            direction ? crossing(*surface, p, surface->R_patch_machine * *direction) : closest_on(*surface, p);
        const Eigen::Vector3d there(xy.x(), xy.y(), surface->height(xy));
        const Eigen::Vector3d next = surface->origin + surface->radius * (surface->R_patch_machine.transpose() * there);
        if (!next.allFinite()) return std::nullopt;
        const double moved = xy.norm();
        foot = next;
        if (moved > kSettled && step + 1 < kFootSteps) continue;
        // The first foot may be a point of the border; only the last one must be surrounded, and be where it settled.
        if (!surface->covered || moved > 1) return std::nullopt;
        const Eigen::Vector2d slope = surface->slope(xy);
        const Eigen::Vector3d normal =
            surface->R_patch_machine.transpose() * Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
        const Quadratic at = terms(xy.x(), xy.y());
        const double sigma = surface->radius * std::sqrt(at.dot(surface->covariance * at));
        const Eigen::Vector3d offset = point - foot;
        if (direction) return Foot{direction->dot(offset), normal, sigma};
        return Foot{std::copysign(offset.norm(), offset.dot(normal)), normal, sigma};
    }
    return std::nullopt;
}

CloudReference::CloudReference(const Cloud& cloud) : state_(std::make_unique<State>(cloud)) {}
CloudReference::~CloudReference() = default;

std::optional<CloudReference::Foot> CloudReference::closest(const Eigen::Vector3d& point) const
{
    return state_->find(point, nullptr);
}

std::optional<CloudReference::Foot> CloudReference::along(const Eigen::Vector3d& point,
                                                          const Eigen::Vector3d& direction) const
{
    return state_->find(point, &direction);
}

} // namespace fettle
