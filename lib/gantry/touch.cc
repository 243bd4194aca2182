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
#include <utility>

namespace fettle::gantry {
namespace {

const std::string kGantry = "gantry:exec:";
/// Places of touches that were written to a file and read again are equal but for rounding.
constexpr double kMaxCopyDistance = 1e-6; // mm

double search_limit(const job::Job& job)
{
    double low = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling})
        for (Eigen::Index i = 0; i < points->cols(); ++i)
            if (!std::isnan((*points)(2, i))) low = std::min(low, (*points)(2, i));
    if (std::isinf(low))
        throw core::InputError(job.source, "how deep to search is not known: give the boundary points their z");
    return 2 * low - job.safe_height;
}

} // namespace

GantryProbe::GantryProbe(Gantry& gantry, const job::Job& job, std::vector<Eigen::Vector3d> known,
                         std::function<void(const Eigen::Vector3d&)> touched)
    : gantry_(gantry), job_(job), lowest_(search_limit(job)), touches_(std::move(known)), touched_(std::move(touched))
{
}

Eigen::Matrix3Xd GantryProbe::operator()(const sampling::TouchPlan& plan)
{
    std::vector<Eigen::Index> new_points;
    for (Eigen::Index i = 0; i < plan.size(); ++i)
        if (find_touch(plan.xy.col(i)) == nullptr) new_points.push_back(i);
    for (const Eigen::Index i : sampling::short_probing_path(plan.xy(Eigen::all, new_points))) {
        const Eigen::Vector2d xy = plan.xy.col(new_points[i]);
        touches_.emplace_back(xy.x(), xy.y(), gantry_.probe(xy, lowest_));
        if (touched_) touched_(touches_.back());
    }
    Eigen::Matrix3Xd touches(3, plan.size());
    for (Eigen::Index i = 0; i < plan.size(); ++i) touches.col(i) = *find_touch(plan.xy.col(i));
    const double radius = job_.probe.tip_radius;
    if (radius == 0) return touches;
    touches.row(2).array() += radius;
    return sampling::contact_points(job_, touches, radius);
}

const Eigen::Vector3d* GantryProbe::find_touch(const Eigen::Vector2d& xy) const
{
    const auto at = std::ranges::find_if(
        touches_, [&](const auto& touch) { return (touch.head(2) - xy).norm() <= kMaxCopyDistance; });
    return at == touches_.end() ? nullptr : &*at;
}

TouchedPart open_touched_part(const std::string& on, const job::Job& job, const TouchOptions& options)
{
    TouchedPart part;
    part.name = core::display_name(on);
    if (on.rfind(kGantry, 0) == 0) {
        if (options.unit || !options.noise.empty())
            throw core::InputError("--on-units, --noise: for a SURFACE, not for a gantry");
        if (!job.is_safe_height_known)
            throw core::InputError(job.source,
                                   "gives neither safe_height nor the z of a boundary point: it is not known "
                                   "how high the machine must travel");
        part.machine = std::make_shared<DriverGantry>(on.substr(kGantry.size()), job, options.timeout);
        part.touch = GantryProbe(*part.machine, job);
        return part;
    }
    part.scan = std::make_shared<const sampling::Scan>(sampling::read_scan(on, job, options.unit));
    part.warning = job::part_box_warning(part.scan->bounds(), job);
    const sampling::TouchNoise noise = sampling::parse_noise(options.noise, job.units.mm());
    part.touch = [scan = part.scan, &job, noise, seed = options.seed](const sampling::TouchPlan& plan) {
        return sampling::probe(*scan, job, plan, noise, seed);
    };
    return part;
}

} // namespace fettle::gantry
