#include "gantry/touch_job.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "job/plausible.h"
#include "sampling/freeform.h"
#include "sampling/order.h"
#include "sampling/probe.h"

#include <numeric>

namespace fettle::gantry {
namespace {

void choose_adaptively(JobTouches& result, const job::Job& job, const TouchedPart& part, int max_touches)
{
    margin::AdaptiveLimits limits;
    limits.max_touches = max_touches;
    limits.max_band = job.tolerance;
    result.adaptive = margin::touch_adaptively(job, limits, part.touch);
    const margin::AdaptiveTouches& found = *result.adaptive;
    result.plan = found.plan;
    for (const Eigen::Vector2d& xy : found.unreachable)
        result.warnings.push_back(part.name + ": no surface at " + job::point_text(xy, job.units) +
                                  "; touched elsewhere");
    if (found.band_reached) return;
    const double mm = job.units.mm();
    result.warnings.push_back(std::to_string(found.plan.size()) + " touches leave a predicted error band of " +
                              core::to_short_text(found.band[found.band.size() - 1] / mm) +
                              ", more than the tolerance " + core::to_short_text(job.tolerance / mm));
}

void choose_by_hill_climbing(JobTouches& result, const job::Job& job, const TouchedPart* part,
                             const TouchRequest& request)
{
    if (job.surface != job::SurfaceType::freeform)
        throw core::InputError(job.source, "--strategy hillclimb is for free-form jobs");
    if (request.lines > 0) throw core::InputError("--lines is for --strategy wang");
    if (part == nullptr || !part->scan)
        throw core::InputError(job.source, "--strategy hillclimb needs the surface: --on SURFACE");
    try {
        result.best = margin::best_touches(*part->scan, job, request.search);
    } catch (const core::InputError& error) {
        throw core::InputError(part->name, error.what());
    }
    result.plan = result.best->plan;
}

void choose(JobTouches& result, const job::Job& job, const TouchedPart* part, const TouchRequest& request)
{
    if (request.strategy == TouchStrategy::adaptive) {
        if (part == nullptr || request.plan_only)
            throw core::InputError("--strategy adaptive needs a part to touch: --on SURFACE");
        choose_adaptively(result, job, *part, request.max_touches);
    } else if (request.strategy == TouchStrategy::hillclimb) {
        choose_by_hill_climbing(result, job, part, request);
    } else if (const int lines = request.lines; lines > 0) {
        result.plan = sampling::plan_freeform(job, sampling::LineCount{lines, lines});
    } else {
        result.plan = sampling::plan_touches(job);
    }
    if (request.sampling_boundary) sampling::append_sampling_boundary(result.plan, job);
}

Eigen::Matrix3Xd planned_points(const sampling::TouchPlan& plan)
{
    Eigen::Matrix3Xd points(3, plan.size());
    points << plan.xy, plan.z.transpose();
    return points;
}

void touch(JobTouches& result, const job::Job& job, const TouchedPart* part, bool plan_only)
{
    if (result.adaptive) {
        result.touches = result.adaptive->touches; // made already, in their order
        result.order.resize(static_cast<std::size_t>(result.touches.cols()));
        std::iota(result.order.begin(), result.order.end(), Eigen::Index{0});
        return;
    }
    if (part != nullptr && !plan_only) {
        result.touches = part->touch(result.plan);
        sampling::check_all_touched(result.touches, job, result.plan, part->name, part->warning);
        if (!part->warning.empty()) result.warnings.push_back(part->name + ": " + part->warning);
    } else {
        result.touches = planned_points(result.plan);
        if (!plan_only && result.touches.row(2).hasNaN())
            throw core::InputError(job.source, "touch points without z: name the part to touch, --on SURFACE");
    }
    result.order = sampling::short_probing_path(result.touches.topRows<2>());
}

void check_heights(JobTouches& result, const job::Job& job, const TouchedPart* part)
{
    const double mm = job.units.mm(), highest = result.touches.row(2).maxCoeff<Eigen::PropagateNumbers>();
    std::string doubt = part != nullptr ? job::touch_height_warning(result.touches, job) : "";
    if (part != nullptr && doubt.empty()) doubt = job::boundary_height_warning({result.touches, result.plan.role}, job);
    if (!doubt.empty())
        result.warnings.push_back(part->name + ": " + doubt);
    else if (job.is_safe_height_known && highest > job.safe_height)
        result.warnings.push_back("safe_height " + core::to_short_text(job.safe_height / mm) +
                                  " is below a touch at z " + core::to_short_text(highest / mm));
}

} // namespace

JobTouches touch_job(const job::Job& job, const TouchedPart* part, const TouchRequest& request)
{
    JobTouches result;
    choose(result, job, part, request);
    touch(result, job, part, request.plan_only);
    check_heights(result, job, request.plan_only ? nullptr : part);
    return result;
}

json::Value to_json(const JobTouches& result, const job::Job& job)
{
    const double mm = job.units.mm();
    json::Value report;
    if (const auto& adaptive = result.adaptive)
        report.set("predicted_band", adaptive->band[adaptive->band.size() - 1] / mm)
            .set("within_tolerance", adaptive->band_reached);
    if (const auto& best = result.best)
        report.set("candidates", best->candidates)
            .set("evaluations", best->search_result.evaluations)
            .set("start_band", best->search_result.start_error / mm)
            .set("band", best->search_result.error / mm);
    return report.set("touches", result.plan.size())
        .set("lines", result.plan.curve.maxCoeff() + 1)
        .set("probing_time", sampling::probing_time(result.touches, result.order, job.safe_height))
        .set("path_length", sampling::probing_path_length(result.touches.topRows<2>(), result.order) / mm)
        .set("tip_radius", job.probe.tip_radius / mm);
}

} // namespace fettle::gantry
