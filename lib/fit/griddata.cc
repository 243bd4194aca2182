#include "fit/griddata.h"

#include "core/error.h"
#include "fit/estimated.h"
#include "job/boundary.h"
#include "sampling/touch_plan.h"
#include "surface/griddata.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

/// Half the mean distance of neighbours of points spread evenly over their hull, mm.
double default_spacing(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(job::area(job::convex_hull(points)) / points.cols()) / 2;
}

/// The input with the measured points of the sampling boundary as touches on no line, except where there are touches.
FitInput with_sampling_boundary(FitInput input)
{
    const std::vector<Eigen::Index> used = usable_points(input, kSampleAndEstimatedRoles);
    std::vector<Eigen::Index> measured;
    for (const Eigen::Index i :
         sampling::untouched_sampling_points(input.job, input.xyz(Eigen::all, used).topRows<2>()))
        if (std::isfinite(input.job.sampling(2, i))) measured.push_back(i);
    const auto added = static_cast<Eigen::Index>(measured.size()), size = input.xyz.cols() + added;
    input.xyz.conservativeResize(3, size);
    input.xyz.rightCols(added) = input.job.sampling(Eigen::all, measured);
    input.roles.conservativeResize(size);
    input.roles.tail(added).setConstant(static_cast<int>(sampling::Role::near_sampling_boundary));
    if (input.curves.size() == 0) return input;
    input.curves.conservativeResize(size);
    input.curves.tail(added).setConstant(sampling::kNoLine);
    return input;
}

/// A point to interpolate: the mean of touches.
struct Node {
    Eigen::Vector3d mean;
    std::vector<Eigen::Index> touches;
    bool is_on_hull = false;
    bool has_boundary_touch = false;
};

bool may_merge(const Node& a, const Node& b)
{
    return !a.is_on_hull && !b.is_on_hull && (a.has_boundary_touch || b.has_boundary_touch);
}

void merge(Node& node, const Node& other)
{
    const auto size = static_cast<double>(node.touches.size()), added = static_cast<double>(other.touches.size());
    node.mean = (size * node.mean + added * other.mean) / (size + added);
    node.touches.insert(node.touches.end(), other.touches.begin(), other.touches.end());
    node.has_boundary_touch = true;
}

/// Merges the closest two nodes, as long as they are closer than min_distance. The corners of the hull stay where they
/// are, so that the surface covers all that it covered.
void merge_close(std::vector<Node>& nodes, double min_distance)
{
    while (true) {
        double closest = min_distance;
        std::size_t first = 0, second = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (std::size_t k = i + 1; k < nodes.size(); ++k) {
                const double distance = (nodes[i].mean - nodes[k].mean).head<2>().norm();
                if (distance >= closest || !may_merge(nodes[i], nodes[k])) continue;
                closest = distance;
                first = i;
                second = k;
            }
        if (second == 0) return;
        merge(nodes[first], nodes[second]);
        nodes.erase(nodes.begin() + second);
    }
}

/// Weights of the touches in the points to interpolate, one row a point. Boundary touches closer than min_distance to
/// other touches are averaged with them: interpolated, two heights that differ by the touches' error are a wave that is
/// shorter than what is kept, and sampling does not remove it.
Eigen::MatrixXd node_weights(const surface::Surface& surface, double min_distance)
{
    const job::Polygon hull = job::convex_hull(surface.touches.topRows<2>());
    std::vector<Node> nodes;
    for (Eigen::Index i = 0; i < surface.touches.cols(); ++i) {
        const Eigen::Vector3d touch = surface.touches.col(i);
        const bool is_on_hull =
            std::ranges::any_of(hull.colwise(), [&](const auto& corner) { return corner == touch.head<2>(); });
        nodes.push_back(
            {touch, {i}, is_on_hull, surface.roles[i] == static_cast<int>(sampling::Role::anomaly_boundary)});
    }
    merge_close(nodes, min_distance);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(std::ssize(nodes), surface.touches.cols());
    for (Eigen::Index n = 0; n < weights.rows(); ++n) {
        const Node& node = nodes[n];
        for (const Eigen::Index i : node.touches) weights(n, i) = 1 / static_cast<double>(node.touches.size());
    }
    return weights;
}

} // namespace

Fit fit_griddata(const FitInput& touched)
{
    constexpr int kMinPoints = 3;
    const FitInput input = with_sampling_boundary(touched);
    surface::Surface surface = begin_surface(input, "griddata", kSampleAndEstimatedRoles, kMinPoints);
    const double spacing = input.spacing.value_or(default_spacing(surface.touches.topRows<2>()));
    // Beneath the wheel a difference between two touches is error, too: its edge spans the wave.
    const Eigen::MatrixXd weights = node_weights(surface, std::min(spacing, input.job.wheel.width));
    try {
        surface.shape = surface::make_griddata(surface.touches * weights.transpose(), spacing, input.job.theta);
        const Eigen::MatrixXd jacobian = weights * touch_jacobian(input, surface);
        surface.covariance = surface.touch_sigma * surface.touch_sigma * jacobian * jacobian.transpose();
    } catch (const core::InputError& error) {
        throw core::InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle::fit
