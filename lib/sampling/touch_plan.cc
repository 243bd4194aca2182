#include "sampling/touch_plan.h"

#include "sampling/freeform.h"
#include "sampling/planar.h"
#include "sampling/swept.h"

#include <limits>

namespace fettle {

void append_line(TouchPlan& plan, const Eigen::Matrix2Xd& working, double theta, int curve,
                 const std::vector<Role>& roles)
{
    const Eigen::Index before = plan.size(), count = working.cols();
    plan.xy.conservativeResize(2, before + count);
    plan.z.conservativeResize(before + count);
    plan.curve.conservativeResize(before + count);
    plan.role.conservativeResize(before + count);
    plan.xy.rightCols(count) = rotation_working_machine(theta).transpose() * working;
    plan.z.tail(count).setConstant(std::numeric_limits<double>::quiet_NaN());
    plan.curve.tail(count).setConstant(curve);
    for (Eigen::Index i = 0; i < count; ++i)
        plan.role[before + i] = static_cast<int>(roles[static_cast<std::size_t>(i)]);
}

TouchPlan plan_touches(const Job& job)
{
    switch (job.surface) {
    case SurfaceType::plane:
        return plan_plane(job);
    case SurfaceType::swept:
        return plan_swept(job);
    case SurfaceType::freeform:
        break;
    }
    return plan_freeform(job);
}

std::optional<Crossings> crossings_around(const Boundaries& boundaries, const Eigen::Vector2d& origin,
                                          const Eigen::Vector2d& direction, double least)
{
    const std::vector<Interval> anomaly = inside(boundaries.anomaly, origin, direction);
    if (anomaly.empty()) return std::nullopt;
    const std::vector<Interval> free = subtract(inside(boundaries.sampling, origin, direction), anomaly, least);

    Crossings t;
    bool before = false, after = false;
    for (const Interval& stretch : free) {
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

} // namespace fettle
