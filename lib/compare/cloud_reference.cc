#include "compare/cloud_reference.h"

#include "cloud/neighbours.h"
#include "core/decompositions.h"

#include <Eigen/Cholesky>

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
constexpr double kWidestGap = 150 * std::numbers::pi / 180;
constexpr double kNearest = 0.6;
// Along a direction the heights are taken in it if the surface is not steeper to it than 60°: quadratics are then
// exact.
constexpr double kSteepest = 0.5;
// Tukey's biweight at 95 % efficiency for normal noise, and the factor from the median |residual| to sigma.
constexpr double kTukey = 4.685;
constexpr double kMedianToSigma = 1.4826;
constexpr int kRobustPasses = 3;
// The foot moves by the curvature over the way from the first neighbour: it settles in two or three steps.
constexpr int kFootSteps = 6;
constexpr double kSettled = 0.05; // of the neighbourhood's radius: so far off its middle a patch is as good
// A neighbour nearer than this share of the radius is the foot itself, but for rounding: it lies in no direction.
constexpr double kAtFoot = 1e-3;
constexpr int kNewton = 20;

using Quadratic = Eigen::Matrix<double, 6, 1>;

Quadratic terms(double x, double y) { return {1, x, y, x * x, x * y, y * y}; }

using Local = Eigen::Matrix<double, 3, kNeighbours>;

/// z = c·terms(x, y) in a frame of its own; lengths are shares of `radius`.
struct Patch {
    Local neighbours;
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
    /// The point of the surface over xy, in M.
    Eigen::Vector3d at(const Eigen::Vector2d& xy) const
    {
        return origin + radius * (R_patch_machine.transpose() * Eigen::Vector3d(xy.x(), xy.y(), height(xy)));
    }
    /// Over what xy the foot of `point` lies: the closest one, or along the direction if there is one.
    Eigen::Vector2d foot(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const;
    Eigen::Vector2d closest(const Eigen::Vector3d& point) const;
    Eigen::Vector2d crossing(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
};

double median_of(std::array<double, kNeighbours> values)
{
    std::nth_element(values.begin(), values.begin() + kNeighbours / 2, values.end());
    return values[kNeighbours / 2];
}

// Least squares, then re-weighted `robust_passes` times. False if the points do not determine a quadratic.
bool fit_quadratic(Patch& patch, int robust_passes)
{
    const Local& local = patch.neighbours;
    Eigen::Matrix<double, kNeighbours, 6> A;
    for (Eigen::Index i = 0; i < kNeighbours; ++i) A.row(i) = terms(local(0, i), local(1, i)).transpose();
    const Eigen::Matrix<double, kNeighbours, 1> z = local.row(2).transpose();
    Eigen::Matrix<double, kNeighbours, 1> weight = Eigen::Matrix<double, kNeighbours, 1>::Ones();
    for (int pass = 0; pass <= robust_passes; ++pass) {
        const Eigen::Matrix<double, 6, 6> normal = A.transpose() * weight.asDiagonal() * A;
        const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
        // In shares of the radius a well spread neighbourhood has pivots near 1; float coordinates leave 1e-7.
        constexpr double kLeastPivot = 1e-7;
        if (!(solver.vectorD().minCoeff() > kLeastPivot)) return false;
        patch.c = solver.solve(A.transpose() * (weight.asDiagonal() * z));
        if (robust_passes == 0) return true;
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

// Is there a neighbour in every direction from the origin? One at the origin itself lies in none.
bool surrounds(const Local& local)
{
    std::vector<double> angle;
    for (Eigen::Index i = 0; i < kNeighbours; ++i)
        if (local.col(i).norm() > kAtFoot) angle.push_back(std::atan2(local(1, i), local(0, i)));
    if (angle.empty()) return false;
    std::sort(angle.begin(), angle.end());
    double widest = angle.front() + 2 * std::numbers::pi - angle.back();
    for (std::size_t i = 1; i < angle.size(); ++i) widest = std::max(widest, angle[i] - angle[i - 1]);
    return widest <= kWidestGap;
}

// By Newton from below the point.
Eigen::Vector2d Patch::closest(const Eigen::Vector3d& point) const
{
    Eigen::Vector2d xy(0, 0);
    Eigen::Matrix2d second;
    second << 2 * c[3], c[4], c[4], 2 * c[5];
    for (int i = 0; i < kNewton; ++i) {
        const double below = height(xy) - point.z();
        const Eigen::Vector2d tilt = slope(xy);
        const Eigen::Vector2d gradient = xy - point.head<2>() + below * tilt;
        Eigen::Matrix2d hessian = Eigen::Matrix2d::Identity() + tilt * tilt.transpose();
        const Eigen::Matrix2d full = hessian + below * second;
        if (full.determinant() > 0 && full.trace() > 0) hessian = full; // else Gauss-Newton's, always downhill
        const Eigen::Vector2d step = -hessian.ldlt().solve(gradient);
        xy += step;
        if (step.norm() <= 1e-12) break; // roundoff of coordinates of size 1
    }
    return xy;
}

// Where the line point + t direction meets the surface, from its crossing with the frame's plane.
Eigen::Vector2d Patch::crossing(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const
{
    double t = -point.z() / direction.z();
    for (int i = 0; i < kNewton; ++i) {
        const Eigen::Vector3d at = point + t * direction;
        const double rise = direction.z() - slope(at.head<2>()).dot(direction.head<2>());
        const double step = -(at.z() - height(at.head<2>())) / rise;
        t += step;
        if (!(std::abs(step) > 1e-12)) break; // roundoff of coordinates of size 1
    }
    return (point + t * direction).head<2>();
}

Eigen::Vector2d Patch::foot(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const
{
    const Eigen::Vector3d local = R_patch_machine * (point - origin) / radius;
    return direction ? crossing(local, R_patch_machine * *direction) : closest(local);
}

} // namespace

struct CloudReference::State {
    explicit State(const Cloud& cloud) : points(cloud.xyz), neighbours(cloud.xyz)
    {
        if (has_normals(cloud)) outward = normals(cloud);
    }

    std::optional<Patch> quick_patch(const Eigen::Vector3d& foot, const Eigen::Vector3d* direction) const;
    std::optional<Foot> find(const Eigen::Vector3d& point, const Eigen::Vector3d* direction) const;

    Eigen::Matrix3Xd points;
    Eigen::Matrix3Xd outward; ///< empty: no normals
    Neighbours neighbours;
};

// The surface about `foot` by plain least squares, with the frame's origin beside it.
std::optional<Patch> CloudReference::State::quick_patch(const Eigen::Vector3d& foot,
                                                        const Eigen::Vector3d* direction) const
{
    const std::vector<Eigen::Index> near = neighbours.nearest(foot, kNeighbours);
    if (static_cast<Eigen::Index>(near.size()) < kNeighbours) return std::nullopt;
    Patch patch;
    Local& local = patch.neighbours;
    local = points(Eigen::all, near);
    const Eigen::Vector3d centroid = local.rowwise().mean();
    const Local about = local.colwise() - centroid;
    const SymmetricEigen<3> spread = symmetric_eigen<3>(about * about.transpose());
    Eigen::Vector3d z = spread.vectors.col(0), x = spread.vectors.col(2);
    Eigen::Vector3d out = direction ? *direction : Eigen::Vector3d::UnitZ();
    if (!direction && outward.cols() > 0) out = outward(Eigen::all, near).rowwise().sum();
    if (z.dot(out) < 0) z = -z;
    if (direction && z.dot(*direction) >= kSteepest) {
        z = *direction;
        x = z.unitOrthogonal();
    }
    patch.R_patch_machine << x.transpose(), z.cross(x).transpose(), z.transpose();
    patch.origin = foot - z.dot(foot - centroid) * z;
    local = patch.R_patch_machine * (local.colwise() - patch.origin);
    patch.radius = local.colwise().norm().maxCoeff();
    if (!(patch.radius > 0)) return std::nullopt;
    local /= patch.radius;
    patch.covered = local.colwise().norm().minCoeff() <= kNearest && surrounds(local);
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
    for (int step = 0; step < kFootSteps; ++step) {
        surface = quick_patch(foot, direction);
        if (!surface) return std::nullopt;
        xy = surface->foot(point, direction);
        if (!xy.allFinite()) return std::nullopt;
        if (xy.norm() <= kSettled) break;
        foot = surface->at(xy);
    }
    // The first foot may be a point of the border; only the last one must be surrounded, and be near its patch's
    // middle.
    if (!surface->covered || !fit_quadratic(*surface, kRobustPasses)) return std::nullopt;
    xy = surface->foot(point, direction);
    if (!(xy.norm() <= 1)) return std::nullopt;
    const Eigen::Vector2d slope = surface->slope(xy);
    const Eigen::Vector3d normal =
        surface->R_patch_machine.transpose() * Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    const Quadratic here = terms(xy.x(), xy.y());
    const double sigma = surface->radius * std::sqrt(here.dot(surface->covariance * here));
    const Eigen::Vector3d at = surface->at(xy), offset = point - at;
    if (direction) return Foot{direction->dot(offset), normal, at, sigma};
    return Foot{std::copysign(offset.norm(), offset.dot(normal)), normal, at, sigma};
}

CloudReference::CloudReference(const Cloud& cloud) : state_(std::make_unique<State>(cloud)) {}
CloudReference::CloudReference(CloudReference&&) noexcept = default;
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
