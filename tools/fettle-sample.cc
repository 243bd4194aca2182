#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "gantry/touch_job.h"
#include "job/frame.h"
#include "job/safe_height.h"
#include "sampling/freeform.h"
#include "sampling/probe.h"

#include <optional>

using namespace fettle;

namespace {

constexpr int kMaxTouches = 1000, kMaxMutations = 1000000; // more would take hours: each is a fit

struct Options {
    cli::Tool& t;
    const std::string& job = t.positional_file("JOB", "The job, JSON");
    const std::string& on = t.optional_file(
        "--on", "SURFACE|gantry:exec:COMMAND",
        "Part to touch: mesh (STL, PLY, OBJ, OFF), cloud (PCD, PLY, XYZ), or the part on a machine, through its driver "
        "(docs/driver.md)");
    const std::optional<units::Units::Length>& part_unit =
        t.length_unit("--on-units", "Unit of that file, if it is not the job's");
    const std::string& noise = t.text("--noise", "", "uniform:A|normal:A",
                                      "Touch error, in the job's unit: within ±A, or normal with 99 % within ±A");
    const std::optional<double>& tip = t.optional_number(
        "--tip", "LENGTH",
        "Radius of the probe's ball, job's unit; 0: a point. Keep the boundary points that far from the anomaly [the "
        "job's tip_radius]",
        core::Range::at_least(0));
    const int& lines =
        t.count("--lines", 0, "Free-form jobs: number of lines in each direction; 0: after Wang's eq. 4-5", 0,
                sampling::kMaxProbingLines);
    const bool& sampling_boundary =
        t.flag("--sampling-boundary", "Wang: touch the points of the sampling boundary, too: griddata then is defined "
                                      "over all of the anomaly");
    const gantry::TouchStrategy& strategy = t.choice<gantry::TouchStrategy>(
        "--strategy",
        {{"extended", gantry::TouchStrategy::extended},
         {"wang", gantry::TouchStrategy::wang},
         {"adaptive", gantry::TouchStrategy::adaptive},
         {"hillclimb", gantry::TouchStrategy::hillclimb}},
        "wang: by his rules; adaptive: one after the other, each where it lowers the predicted error band most, "
        "until that meets the job's tolerance; extended: by his rules, then adaptive while the band exceeds the "
        "tolerance or the fit leaves out a touch, adaptive alone where his rules find no room on one side of the "
        "anomaly, or go over an edge of the part; without --on by his rules alone; hillclimb: by his Appendix A the "
        "best subset of many candidates, for a SURFACE that is known beneath the anomaly, too");
    const int& max_touches =
        t.count("--max-touches", 60, "Extended, adaptive: maximum number of touches", 6, kMaxTouches);
    const int& touches =
        t.count("--touches", 0, "Hillclimb: number of touches; 0: as many as wang takes", 0, kMaxTouches);
    const double& candidate_spacing =
        t.number("--candidates", 0, "LENGTH", "Hillclimb: spacing of the candidates; 0: for about a thousand of them",
                 core::Range::at_least(0));
    const std::string& fit = t.choice("--fit", "griddata", {"griddata", "bspline-wang"},
                                      "Hillclimb: the method whose error band inside the anomaly is minimised");
    const int& mutations = t.count(
        "--mutations", 500, "Hillclimb: random changes tried before candidates are discarded; ten times as many after",
        0, kMaxMutations);
    const std::optional<double>& sharpness =
        t.optional_number("--sharpness", "K",
                          "Hillclimb: a discard that widens the band by d is accepted with probability exp(-K d) [ln "
                          "100 / the probe's accuracy]",
                          core::Range::at_least(0));
    const double& timeout = gantry::declare_timeout(t);
    const bool& plan_only = t.flag("--plan-only", "Choose only: x and y, no z but where the job gives it");
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example(
        "fettle-sample jobs/hammer.json --on scans/hammer.stl --noise normal:0.1 --seed 7 > samples.pcd",
        "touch a scanned hammer until the predicted error meets the tolerance, 99 % of the touches within 0.1 mm");
    t.reference("Wang 2007, 4.4.4 (touch points), eq. 4-5 (number of lines), Appendix A (hill climbing)");
}

gantry::TouchRequest request(const Options& o, double mm)
{
    margin::TouchSearch search = {o.touches, o.candidate_spacing * mm, o.fit, o.mutations, {}, o.t.seed()};
    if (o.sharpness) search.sharpness = *o.sharpness / mm;
    return {o.strategy, o.lines, o.sampling_boundary, o.max_touches, search, o.plan_only};
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Choose the touch points of a job and probe them on a part.", [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();

        job::Job job = job::read_job(o.job);
        const double mm = job.units.mm();
        if (o.tip) job.probe.tip_radius = *o.tip * mm;
        sampling::parse_noise(o.noise, mm); // throws, also if nothing is touched
        if (o.lines > 0 && job.surface != job::SurfaceType::freeform)
            throw core::InputError(core::display_name(o.job), "--lines is for free-form jobs");
        const bool wang = o.strategy == gantry::TouchStrategy::wang;
        const bool by_layout = wang || o.strategy == gantry::TouchStrategy::extended; // needs no part to be planned
        if (o.strategy != gantry::TouchStrategy::hillclimb && (o.touches > 0 || o.candidate_spacing > 0 || o.sharpness))
            throw core::InputError("--touches, --candidates, --sharpness: only for --strategy hillclimb");
        if (!by_layout && o.sampling_boundary) throw core::InputError("--sampling-boundary is for --strategy wang");

        std::optional<gantry::TouchedPart> part;
        if (!o.on.empty() && (!o.plan_only || !by_layout))
            part = gantry::open_touched_part(o.on, job, {o.part_unit, o.noise, t.seed(), o.timeout});
        if (part && part->scan) job::set_safe_height_over(job, part->scan->bounds().max().z());
        const gantry::JobTouches result = gantry::touch_job(job, part ? &*part : nullptr, request(o, mm));
        for (const std::string& warning : result.warnings) t.warn(warning);

        t.report() = gantry::to_json(result, job);
        t.note(std::to_string(result.plan.size()) + " touches" +
               (result.adaptive ? "" : " on " + std::to_string(result.plan.curve.maxCoeff() + 1) + " lines"));
        o.out.write(job::in_job_frame(sampling::sample_cloud(result.touches, result.plan, result.order), job),
                    job.units);
        return cli::Verdict::yes;
    });
}
