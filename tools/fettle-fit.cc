#include "cli/tool.h"
#include "core/text.h"
#include "fit/fit_file.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

std::vector<std::string> methods()
{
    std::vector<std::string> names = {"auto"};
    names.insert(names.end(), fit::fit_methods().begin(), fit::fit_methods().end());
    return names;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Fit the desired surface beneath the anomaly to the touches.", [](cli::Tool& t) {
        const std::string& job_file = t.positional_file("JOB", "Job, JSON");
        const std::string& points = t.main_input(
            "POINTS",
            "Touches (x y z, role) or, without roles, a scan (x y z, normals), PCD; binary ones are streamed");
        const std::string& method =
            t.choice("-m,--method", "auto", methods(),
                     "Kind of surface; auto: what explains the touches best, weighed against the others. Plane jobs: a "
                     "plane; swept ones: straight along their direction");
        const fit::PointKind& kind =
            t.choice<fit::PointKind>("--as",
                                     {{"by-roles", fit::PointKind::by_roles},
                                      {"touches", fit::PointKind::touches},
                                      {"scan", fit::PointKind::scan}},
                                     "What the points are. Touches: all on good metal, as accurate as the job's probe. "
                                     "A scan: those inside the anomaly or outside the sampling boundary, and those "
                                     "whose normals point down or sideways, are left out; its noise and waves are "
                                     "estimated. By roles: touches have roles, a scan has none");
        const bool& use_boundary = t.flag(
            "--use-boundary", "Take the anomaly's boundary points as touches, too: those of role 0, else the job's "
                              "that have a z; planes always do");
        const bool& estimate_noise = t.choice<bool>(
            "--noise", {{"job", false}, {"estimate", true}},
            "Standard deviation of a touch: by the probe's accuracy that the job names, or by the residuals, "
            "which takes 3 touches more than the surface needs; sigma then is Student's t's. A scan's "
            "always is by the residuals");
        const std::optional<units::Units::Length>& file_unit =
            t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
        const std::optional<double>& spacing =
            t.optional_number("--spacing", "LENGTH",
                              "Griddata: half the shortest wave to keep; 0: do not sample again; else half the "
                              "mean distance of the points",
                              core::Range::at_least(0));
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json > surface.json",
                  "touch a scanned hammer and fit a free-form surface");
        t.reference("Wang (2007), 4.2 to 4.4; Hoeting et al. (1999), Bayesian model averaging: auto");
        t.output_formats({"json"});
        t.parse();

        const job::Job job = job::read_job(job_file);
        const fit::FitRun run =
            fit::fit_file(job, {points, file_unit, method, kind, use_boundary, estimate_noise, spacing});
        const surface::Surface& surface = run.fit.surface;
        t.report() = run.report;
        for (const std::string& warning : run.warnings) t.warn(warning);
        if (!run.fit.converged) {
            t.warn("the " + surface.method + " fit did not converge in " + std::to_string(run.fit.iterations) +
                   " iterations");
            return cli::Verdict::no;
        }
        t.note(surface.method + " fit of " + std::to_string(run.touches) + " touches, " + std::to_string(run.ignored) +
               " points ignored, rms " + core::to_text(surface.rms / surface.units.mm()) + " " +
               units::to_string(surface.units.length));
        t.output() << surface::to_json(surface);
        return cli::Verdict::yes;
    });
}
