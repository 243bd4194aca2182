#include "carrier/work_points.h"

#include "plan/tool_path.h"

#include <algorithm>
#include <cmath>

namespace fettle::carrier {
namespace {

/// Adds the points of a straight line from the last point to `end`.
void add_line(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& end)
{
    const Eigen::Vector3d begin = points.back();
    const int count = std::max(1, static_cast<int>(std::ceil((end - begin).norm() / kWorkPointSpacing)));
    for (int i = 1; i <= count; ++i) points.push_back(begin + (end - begin) * (static_cast<double>(i) / count));
}

Eigen::Vector3d at_height(const Eigen::Vector3d& point, double z) { return {point.x(), point.y(), z}; }

/// One contact interval: its points on the desired surface, no farther apart than they need to be.
using Stretch = std::vector<Eigen::Vector3d>;

std::vector<Stretch> stretches_of(const plan::ToolPass& pass)
{
    std::vector<Stretch> stretches;
    for (std::size_t k = 0; k < pass.starts.size(); ++k) {
        const std::size_t end = k + 1 < pass.starts.size() ? pass.starts[k + 1] : pass.points.size();
        Stretch stretch;
        for (std::size_t i = pass.starts[k]; i < end; ++i)
            if (stretch.empty() || i + 1 == end || (pass.points[i] - stretch.back()).norm() >= kWorkPointSpacing)
                stretch.push_back(pass.points[i]);
        stretches.push_back(std::move(stretch));
    }
    return stretches;
}

} // namespace

std::vector<Eigen::Vector3d> work_points(const plan::Plan& plan, const Eigen::Vector3d& from, double top)
{
    const plan::ToolPath path(plan.job, plan.surface, plan.passes, plan.step);
    const job::ForceRange& force = plan.job.force;
    const double depth = std::max(0.0, force.max - force.preload) / force.stiffness, safe = plan.job.safe_height;
    std::vector<Eigen::Vector3d> points = {from};
    for (const plan::ToolPass& pass : path.passes())
        for (const Stretch& stretch : stretches_of(pass)) {
            add_line(points, at_height(stretch.front(), safe));
            for (const Eigen::Vector3d& point : stretch)
                add_line(points, at_height(point, std::max(point.z(), std::min(top, safe))));
            for (auto point = stretch.rbegin(); point != stretch.rend(); ++point)
                add_line(points, at_height(*point, point->z() - depth));
            add_line(points, at_height(stretch.front(), safe));
        }
    return points;
}

} // namespace fettle::carrier
