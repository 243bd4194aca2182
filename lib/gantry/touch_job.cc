#include "gantry/touch_job.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "job/plausible.h"
#include "sampling/freeform.h"
#include "sampling/order.h"
#include "sampling/probe.h"

#include <cmath>
#include <utility>

namespace fettle::gantry {
namespace {

// After a layout touches are added in batches, each as large as a layout of two lines, while a batch lowers the band.
constexpr int kPatience = 8;

// That of fettle-margin by default. The band that is to meet the tolerance is of normal draws without waves about a
// family; the margin has both these and Student's tails.
constexpr double kMarginConfidence = 0.99;

margin::AdaptiveLimits adaptive_limits(const job::Job& job, int max_touches)
{
    margin::AdaptiveLimits limits;
    limits.max_touches = max_touches;
    limits.max_band = job.tolerance;
    return limits;
}

/// Takes over touches that were chosen one after the other.
void set_adaptive(JobTouches& result, const job::Job& job, const TouchedPart& part, margin::AdaptiveTouches chosen)
{
    result.adaptive = std::move(chosen);
    const margin::AdaptiveTouches& found = *result.adaptive;
    result.plan = found.plan;
    result.touches = found.touches; // made already, in their order
    result.order = sampling::short_probing_path(result.touches.leftCols(found.layout).topRows<2>());
    for (Eigen::Index i = found.layout; i < result.plan.size(); ++i) result.order.push_back(i);
    if (!found.unreachable.empty()) {
        const std::size_t more = found.unreachable.size() - 1;
        result.warnings.push_back(part.name + ": no surface at " + job::point_text(found.unreachable[0], job.units) +
                                  (more > 0 ? " and " + std::to_string(more) + " other places" : "") +
                                  "; touched elsewhere");
    }
    if (found.band_reached) return;
    const double mm = job.units.mm(), band = found.band[found.band.size() - 1];
    const std::string tolerance = core::to_short_text(job.tolerance / mm);
    result.warnings.push_back(std::to_string(found.plan.size()) + " touches leave a predicted error band of " +
                              core::to_short_text(band / mm) +
                              (band > job.tolerance
                                   ? ", more than the tolerance " + tolerance
                                   : ", within the tolerance " + tolerance + ", which more of them would confirm"));
}

void extend(JobTouches& result, const job::Job& job, const TouchedPart& part, int max_touches)
{
    margin::AdaptiveLimits limits = adaptive_limits(job, max_touches);
    limits.patience = kPatience;
    limits.confidence = kMarginConfidence;
    set_adaptive(result, job, part, margin::extend_layout(job, result.plan, result.touches, limits, part.touch));
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

/// The layout by Wang's rules; touches chosen one after the other where they may and it has no room, as at an edge.
void choose_layout(JobTouches& result, const job::Job& job, const TouchedPart* part, const TouchRequest& request)
{
    try {
        result.plan = sampling::plan_touches(job);
    } catch (const sampling::NoRoomError& error) {
        if (request.strategy != TouchStrategy::extended || part == nullptr || request.plan_only) throw;
        result.warnings.push_back(std::string(error.what()) + "; touched adaptively");
        set_adaptive(result, job, *part,
                     margin::touch_adaptively(job, adaptive_limits(job, request.max_touches), part->touch));
    }
}

void choose(JobTouches& result, const job::Job& job, const TouchedPart* part, const TouchRequest& request)
{
    if (request.strategy == TouchStrategy::adaptive) {
        if (part == nullptr || request.plan_only)
            throw core::InputError("--strategy adaptive needs a part to touch: --on SURFACE");
        set_adaptive(result, job, *part,
                     margin::touch_adaptively(job, adaptive_limits(job, request.max_touches), part->touch));
    } else if (request.strategy == TouchStrategy::hillclimb) {
        choose_by_hill_climbing(result, job, part, request);
    } else if (const int lines = request.lines; lines > 0) {
        result.plan = sampling::plan_freeform(job, sampling::LineCount{lines, lines});
    } else {
        choose_layout(result, job, part, request);
    }
    if (request.sampling_boundary) sampling::append_sampling_boundary(result.plan, job);
}

Eigen::Matrix3Xd planned_points(const sampling::TouchPlan& plan)
{
    Eigen::Matrix3Xd points(3, plan.size());
    points << plan.xy, plan.z.transpose();
    return points;
}

constexpr int kEdgeSteps = 100; // from a touch to the border of the scan's box

/// Whether a part ends between the anomaly and a place: there is no surface beyond it, either, or only a side of the
/// part below all touches. Beyond a hole there is.
bool is_over_edge(const sampling::Scan& scan, const Eigen::Vector2d& middle, const Eigen::Vector2d& place,
                  double lowest_touch)
{
    const Eigen::Vector2d away = (place - middle).normalized() * scan.bounds().diagonal().norm() / kEdgeSteps;
    for (int k = 0; k <= kEdgeSteps; ++k)
        if (const std::optional<double> z = scan.height(place + k * away); z && *z >= lowest_touch) return false;
    return true;
}

/// Whether a layout may give way to touches that are chosen where there is a surface: all that missed are over an edge.
bool misses_at_edge(const JobTouches& result, const job::Job& job, const TouchedPart& part)
{
    if (!part.scan || result.touches.row(2).array().isNaN().all()) return false;
    const Eigen::Vector2d middle = job.anomaly.topRows<2>().rowwise().mean();
    const double lowest = result.touches.row(2).minCoeff<Eigen::PropagateNumbers>();
    bool is_any = false;
    for (Eigen::Index i = 0; i < result.plan.size(); ++i)
        if (std::isnan(result.touches(2, i))) {
            if (!is_over_edge(*part.scan, middle, result.plan.xy.col(i), lowest)) return false;
            is_any = true;
        }
    return is_any;
}

void touch(JobTouches& result, const job::Job& job, const TouchedPart* part, const TouchRequest& request)
{
    if (result.adaptive) return;
    if (part != nullptr && !request.plan_only) {
        result.touches = part->touch(result.plan);
        if (request.strategy == TouchStrategy::extended && misses_at_edge(result, job, *part)) {
            result.warnings.push_back(part->name +
                                      ": touches lie over an edge of the part; touched adaptively, where it is");
            return set_adaptive(result, job, *part,
                                margin::touch_adaptively(job, adaptive_limits(job, request.max_touches), part->touch));
        }
        sampling::check_all_touched(result.touches, job, result.plan, part->name, part->warning);
    } else {
        result.touches = planned_points(result.plan);
        if (!request.plan_only && result.touches.row(2).hasNaN())
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
    if (part != nullptr && part->scan) result.warnings = sampling::scan_warnings(*part->scan, job, part->name);
    choose(result, job, part, request);
    touch(result, job, part, request);
    if (request.strategy == TouchStrategy::extended && part != nullptr && !request.plan_only && !result.adaptive)
        extend(result, job, *part, request.max_touches);
    check_heights(result, job, request.plan_only ? nullptr : part);
    return result;
}

json::Value to_json(const JobTouches& result, const job::Job& job)
{
    const double mm = job.units.mm();
    json::Value report;
    if (const auto& adaptive = result.adaptive)
        report.set("layout_touches", adaptive->layout)
            .set("predicted_band", adaptive->band[adaptive->band.size() - 1] / mm)
            .set("within_tolerance", adaptive->band_reached)
            .set("predicted_bands", Eigen::VectorXd(adaptive->band / mm));
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
