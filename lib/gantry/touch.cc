#include "gantry/touch.h"

#include "core/error.h"
#include "core/file.h"
#include "gantry/driver.h"
#include "job/plausible.h"
#include "sampling/order.h"
#include "sampling/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

const std::string kGantry = "gantry:exec:";

double lowest_of(const Job& job)
{
    double low = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling})
        for (Eigen::Index i = 0; i < points->cols(); ++i)
            if (!std::isnan((*points)(2, i))) low = std::min(low, (*points)(2, i));
    if (std::isinf(low))
        throw InputError(job.source, "how deep to search is not known: give the boundary points their z");
    return 2 * low - job.safe_height;
}

} // namespace

GantryTouches::GantryTouches(Gantry& gantry, const Job& job) : gantry_(gantry), job_(job), lowest_(lowest_of(job)) {}

Eigen::Matrix3Xd GantryTouches::operator()(const TouchPlan& plan)
{
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < plan.size(); ++i)
        if (known(plan.xy.col(i)) == nullptr) open.push_back(i);
    for (const Eigen::Index i : short_way(plan.xy(Eigen::all, open))) {
        const Eigen::Vector2d xy = plan.xy.col(open[static_cast<std::size_t>(i)]);
        touched_.emplace_back(xy.x(), xy.y(), gantry_.probe(xy, lowest_));
    }
    Eigen::Matrix3Xd touches(3, plan.size());
    for (Eigen::Index i = 0; i < plan.size(); ++i) touches.col(i) = *known(plan.xy.col(i));
    const double radius = job_.probe.tip_radius;
    if (radius == 0) return touches;
    touches.row(2).array() += radius;
    return contact_points(job_, touches, radius);
}

const Eigen::Vector3d* GantryTouches::known(const Eigen::Vector2d& xy) const
{
    const auto at = std::find_if(touched_.begin(), touched_.end(),
                                 [&](const Eigen::Vector3d& touch) { return touch.head<2>() == xy; });
    return at == touched_.end() ? nullptr : &*at;
}

TouchedPart touched_part(const std::string& on, const Job& job, const TouchOptions& options)
{
    TouchedPart part;
    part.name = display_name(on);
    if (on.rfind(kGantry, 0) == 0) {
        if (options.unit || !options.noise.empty())
            throw InputError("--on-units, --noise: for a SURFACE, not for a gantry");
        part.machine = std::make_shared<DriverGantry>(on.substr(kGantry.size()), job, options.patience);
        part.touch = GantryTouches(*part.machine, job);
        return part;
    }
    part.scan = std::make_shared<const Scan>(read_scan(on, job.units, options.unit));
    part.doubt = implausible_box(part.scan->bounds(), job);
    const TouchNoise noise = parse_noise(options.noise, job.units.mm());
    part.touch = [scan = part.scan, &job, noise, seed = options.seed](const TouchPlan& plan) {
        return probe(*scan, job, plan, noise, seed);
    };
    return part;
}

} // namespace fettle
