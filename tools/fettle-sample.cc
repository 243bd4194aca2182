#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "core/text.h"
#include "gantry/touch.h"
#include "job/boundary.h"
#include "job/plausible.h"
#include "margin/best_touches.h"
#include "sampling/freeform.h"
#include "sampling/order.h"
#include "sampling/probe.h"

#include <numeric>

using namespace fettle;

namespace {

// More would take hours: each is a fit.
constexpr int kMostTouches = 1000, kMostMutations = 1000000;

Eigen::Matrix3Xd untouched(const TouchPlan& plan)
{
    Eigen::Matrix3Xd places(3, plan.size());
    places << plan.xy, plan.z.transpose();
    return places;
}

Eigen::Matrix3Xd probe_part(const Tool& t, const TouchedPart& part, const Job& job, const TouchPlan& plan)
{
    const Eigen::Matrix3Xd touches = part.touch(plan);
    check_touched(touches, job, plan, part.name, part.doubt);
    if (!part.doubt.empty()) t.warn(part.name + ": " + part.doubt);
    return touches;
}

// What --strategy hillclimb goes by.
struct ClimbOptions {
    const int& touches;
    const double& spacing;
    const std::string& method;
    const int& mutations;
    const std::optional<double>& sharpness;
};

void check_climb(const std::string& source, const Job& job, int lines, bool surface_known)
{
    if (job.surface != SurfaceType::freeform) throw InputError(source, "--strategy hillclimb is for free-form jobs");
    if (lines > 0) throw InputError("--lines is for --strategy wang");
    if (!surface_known) throw InputError(source, "--strategy hillclimb needs the surface: --on SURFACE");
}

TouchPlan climb(Tool& t, const TouchedPart& part, const Job& job, const ClimbOptions& options)
{
    const double mm = job.units.mm();
    TouchSearch search = {options.touches, options.spacing * mm, options.method, options.mutations, {}, t.seed()};
    if (options.sharpness) search.sharpness = *options.sharpness / mm;
    try {
        BestTouches best = best_touches(*part.scan, job, search);
        t.report()
            .set("candidates", static_cast<std::size_t>(best.candidates))
            .set("evaluations", best.found.evaluations)
            .set("start_band", best.found.start_error / mm)
            .set("band", best.found.error / mm);
        return std::move(best.plan);
    } catch (const InputError& error) {
        throw InputError(part.name, error.what());
    }
}

// Touches where the fit learns most, and warns of places where nothing was found.
AdaptiveTouches adapt(Tool& t, const TouchedPart& part, const Job& job, int most)
{
    AdaptiveLimits limits;
    limits.most_touches = most;
    limits.band = job.tolerance;
    AdaptiveTouches found = touch_adaptively(job, limits, part.touch);
    for (const Eigen::Vector2d& xy : found.unreachable)
        t.warn(part.name + ": no surface at " + place(xy, job.units) + "; touched elsewhere");
    const double band = found.band[found.band.size() - 1] / job.units.mm();
    t.report().set("predicted_band", band).set("within_tolerance", found.enough);
    if (!found.enough)
        t.warn(std::to_string(found.plan.size()) + " touches leave a predicted error band of " + to_short_text(band) +
               ", more than the tolerance " + to_short_text(job.tolerance / job.units.mm()));
    return found;
}

std::vector<Eigen::Index> as_planned(const Eigen::Matrix3Xd& touches)
{
    std::vector<Eigen::Index> order(static_cast<std::size_t>(touches.cols()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    return order;
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Choose the touch points of a job and probe them on a part.", [](Tool& t) {
        const std::string& job_file = t.file("JOB", "The job, JSON");
        const std::string& on = t.other_file(
            "--on", "SURFACE|gantry:exec:COMMAND",
            "Part to touch: mesh (STL, PLY, OBJ, OFF), cloud (PCD, PLY, XYZ), or what stands on a machine, "
            "through its driver (docs/driver.md)");
        const auto& part_unit = t.length_unit("--on-units", "Unit of that file, if it is not the job's");
        const std::string& noise_text =
            t.text("--noise", "", "uniform:A|normal:A",
                   "Touch error, in the job's unit: within ±A, or normal with 99 % within ±A");
        const auto& tip = t.number_if_given("--tip", "LENGTH",
                                            "Radius of the probe's ball, job's unit; 0: a point. Keep the boundary "
                                            "points that far from the anomaly [the job's tip_radius]",
                                            Range::at_least(0));
        const int& lines = t.count("--lines", 0, "Free-form jobs: so many lines each way; 0: as many as Wang's eq. 4-5",
                                   0, kMostLines);
        const std::string& strategy =
            t.choice("--strategy", "wang", {"wang", "adaptive", "hillclimb"},
                     "wang: by his rules; adaptive: one after the other, each where it lowers "
                     "the predicted error band most, until that meets the job's tolerance; "
                     "hillclimb: by his Appendix A the best of many places, for a SURFACE that "
                     "is known beneath the anomaly, too");
        const int& most_touches = t.count("--max-touches", 60, "Adaptive: no more than so many", 6, kMostTouches);
        const ClimbOptions climbing = {
            t.count("--touches", 0, "Hillclimb: how many; 0: as many as wang takes", 0, kMostTouches),
            t.number("--candidates", 0, "LENGTH", "Hillclimb: spacing of the places; 0: about a thousand places",
                     Range::at_least(0)),
            t.choice("--fit", "griddata", {"griddata", "bspline-wang"},
                     "Hillclimb: the method whose error band inside the anomaly is lowered"),
            t.count("--mutations", 500,
                    "Hillclimb: random changes tried before places are discarded; ten times as many after", 0,
                    kMostMutations),
            t.number_if_given("--sharpness", "K",
                              "Hillclimb: a discard that widens the band by d is accepted with exp(-K d) "
                              "[ln 100 / the probe's accuracy]",
                              Range::at_least(0))};
        const double& patience = t.number("--patience", 10, "SECONDS",
                                          "A driver may answer so much later than the touch takes", Range::positive());
        const bool& plan_only = t.flag("--plan-only", "Choose only: x and y, no z but where the job gives it");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl --noise normal:0.1 --seed 7 > samples.pcd",
                  "touch a scanned hammer where Wang's rules say, 99 % of the touches within 0.1 mm");
        t.reference("Wang 2007, 4.4.4 (touch points), eq. 4-5 (number of lines), Appendix A (hill climbing)");
        t.parse();

        Job job = read_job(job_file);
        const double mm = job.units.mm();
        if (tip) job.probe.tip_radius = *tip * mm;
        parse_noise(noise_text, mm); // a wrong one shows, touched or not
        if (lines > 0 && job.surface != SurfaceType::freeform)
            throw InputError(display_name(job_file), "--lines is for free-form jobs");
        std::optional<TouchedPart> part;
        if (!on.empty() && (!plan_only || strategy != "wang"))
            part = touched_part(on, job, {part_unit, noise_text, t.seed(), patience});
        TouchPlan plan;
        std::optional<AdaptiveTouches> adapted;
        if (strategy == "adaptive") {
            if (!part || plan_only) throw InputError("--strategy adaptive needs a part to touch: --on SURFACE");
            adapted = adapt(t, *part, job, most_touches);
            plan = adapted->plan;
        } else if (strategy == "hillclimb") {
            check_climb(display_name(job_file), job, lines, part && part->scan);
            plan = climb(t, *part, job, climbing);
        } else {
            if (climbing.touches > 0 || climbing.spacing > 0 || climbing.sharpness)
                throw InputError("--touches, --candidates, --sharpness: only for --strategy hillclimb");
            plan = lines > 0 ? plan_freeform(job, LineCount{lines, lines}) : plan_touches(job);
        }
        Eigen::Matrix3Xd touches = untouched(plan);
        if (adapted) {
            touches = adapted->touches;
        } else if (part && !plan_only) {
            touches = probe_part(t, *part, job, plan);
        } else if (!plan_only && touches.row(2).hasNaN()) {
            throw InputError(display_name(job_file), "touch points without z: name the part to touch, --on SURFACE");
        }
        // Adaptive touches have been made in their order already.
        const std::vector<Eigen::Index> order = adapted ? as_planned(touches) : short_way(touches.topRows<2>());
        const double highest = touches.row(2).maxCoeff<Eigen::PropagateNumbers>();
        if (const std::string doubt = part && !plan_only ? implausible_height(touches, job) : ""; !doubt.empty())
            t.warn(part->name + ": " + doubt);
        else if (highest > job.safe_height)
            t.warn("safe_height " + to_short_text(job.safe_height / mm) + " is below a touch at z " +
                   to_short_text(highest / mm));
        t.report()
            .set("touches", static_cast<std::size_t>(plan.size()))
            .set("lines", plan.curve.maxCoeff() + 1)
            .set("probing_time", probing_time(touches, order, job.safe_height))
            .set("path_length", way_length(touches.topRows<2>(), order) / mm)
            .set("tip_radius", job.probe.tip_radius / mm);
        t.note(std::to_string(plan.size()) + " touches" +
               (adapted ? "" : " on " + std::to_string(plan.curve.maxCoeff() + 1) + " lines"));
        write_pcd(t.output(), sample_cloud(touches, plan, order), job.units,
                  ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return Verdict::yes;
    });
}
