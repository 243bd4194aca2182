#include "sampling/touch_plan.h"

#include "core/constants.h"
#include "core/error.h"
#include "sampling/freeform.h"
#include "sampling/planar.h"
#include "sampling/swept.h"

#include <algorithm>

namespace fettle::sampling {

void append_line(TouchPlan& plan, const Eigen::Matrix2Xd& points, double theta, int curve,
                 const std::vector<Role>& roles)
{
    const Eigen::Index before = plan.size(), count = points.cols();
    plan.xy.conservativeResize(2, before + count);
    plan.z.conservativeResize(before + count);
    plan.curve.conservativeResize(before + count);
    plan.role.conservativeResize(before + count);
    plan.xy.rightCols(count) = job::rotation_working_machine(theta).transpose() * points;
    plan.z.tail(count).setConstant(core::kNaN);
    plan.curve.tail(count).setConstant(curve);
    for (Eigen::Index i = 0; i < count; ++i) plan.role[before + i] = static_cast<int>(roles[i]);
}

TouchPlan plan_touches(const job::Job& job)
{
    switch (job.surface) {
    case job::SurfaceType::plane:
        return plan_plane(job);
    case job::SurfaceType::swept:
        return plan_swept(job);
    case job::SurfaceType::freeform:
        break;
    }
    return plan_freeform(job);
}

std::vector<Eigen::Index> untouched_sampling_points(const job::Job& job, const Eigen::Matrix2Xd& touched)
{
    const Eigen::Matrix2Xd points = job.sampling.topRows<2>();
    std::vector<Eigen::Index> untouched;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const auto is_apart = [&](const Eigen::Vector2d& other) {
            return (other - points.col(i)).norm() > job.probe.accuracy;
        };
        if (std::ranges::all_of(touched.colwise(), is_apart) &&
            std::ranges::all_of(untouched, [&](Eigen::Index k) { return is_apart(points.col(k)); }))
            untouched.push_back(i);
    }
    return untouched;
}

void append_sampling_boundary(TouchPlan& plan, const job::Job& job)
{
    if (job.sampling.cols() == 0) throw core::InputError(job.source, "sampling: there are no points to touch");
    const std::vector<Eigen::Index> added = untouched_sampling_points(job, plan.xy);
    const auto count = static_cast<Eigen::Index>(added.size());
    append_line(plan, job::rotation_working_machine(job.theta) * job.sampling(Eigen::all, added).topRows<2>(),
                job.theta, kNoLine, std::vector<Role>(added.size(), Role::near_sampling_boundary));
    plan.z.tail(count) = job.sampling.row(2)(added).transpose();
}

std::optional<Crossings> crossings_around(const job::Boundaries& boundaries, const Eigen::Vector2d& origin,
                                          const Eigen::Vector2d& direction, double min_length)
{
    const std::vector<job::Interval> anomaly = job::intervals_inside(boundaries.anomaly, origin, direction);
    if (anomaly.empty()) return std::nullopt;
    const std::vector<job::Interval> free =
        job::subtract(job::intervals_inside(boundaries.sampling, origin, direction), anomaly, min_length);

    Crossings t;
    bool before = false, after = false;
    for (const job::Interval& stretch : free) {
        if (stretch.second <= anomaly.front().first) {
            if (!before) t[0] = stretch.first;
            t[1] = stretch.second;
            before = true;
        } else if (stretch.first >= anomaly.back().second) {
            if (!after) t[2] = stretch.first;
            t[3] = stretch.second;
            after = true;
        }
    }
    if (!before || !after) return std::nullopt;
    return t;
}

} // namespace fettle::sampling
