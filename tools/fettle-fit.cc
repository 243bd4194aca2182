#include "cli/tool.h"
#include "cloud/point_source.h"
#include "core/file.h"
#include "core/text.h"
#include "fit/dense.h"
#include "fit/input.h"
#include "fit/report.h"
#include "job/boundary.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

std::vector<std::string> choices()
{
    std::vector<std::string> names = {"auto"};
    names.insert(names.end(), fit_methods().begin(), fit_methods().end());
    return names;
}

/// One warning for each touch that was left out: the operator looks there, or touches again.
void name_gross_errors(Tool& t, const Fit& fit, const std::string& source, const Units& units)
{
    for (const Eigen::Index i : fit.surface.gross_errors)
        t.warn(source + ": the touch at " + place(fit.surface.touches.col(i).head<2>(), units) + " is off by " +
               to_short_text(fit.residuals[i] / units.mm()) + " " + to_string(units.length) + "; left out");
}

/// Touches that lie off every surface by more than the probe's accuracy, and are no slips that could be named.
void warn_of_misfit(Tool& t, const Surface& surface, const std::string& source)
{
    constexpr double kUnlikely = 1e-6; // one good part in a million
    if (!(surface.goodness < kUnlikely) || !surface.gross_errors.empty()) return;
    const auto in_unit = [&](double length) {
        return to_short_text(length / surface.units.mm()) + " " + to_string(surface.units.length);
    };
    t.warn(source + ": the touches lie " + in_unit(surface.rms) +
           " rms off the surface, the probe's accuracy explains " + in_unit(surface.touch_sigma) +
           ": does the anomaly's boundary go around all of it, is the accuracy right?");
}

Verdict finish(Tool& t, const Fit& fit, std::size_t touches, std::size_t ignored)
{
    const Surface& surface = fit.surface;
    if (!fit.converged) {
        t.warn("the " + surface.method + " fit did not converge in " + std::to_string(fit.iterations) + " iterations");
        return Verdict::no;
    }
    t.note(surface.method + " fit of " + std::to_string(touches) + " touches, " + std::to_string(ignored) +
           " points ignored, rms " + to_text(surface.rms / surface.units.mm()) + " " + to_string(surface.units.length));
    t.output() << to_json(surface);
    return Verdict::yes;
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Fit the desired surface beneath the anomaly to the touches.", [](Tool& t) {
        const std::string& job_file = t.file("JOB", "Job, JSON");
        const std::string& points = t.input(
            "POINTS", "Touches (x y z, role) or, without roles, a scan, PCD; more than 300 are streamed if binary");
        const std::string& method =
            t.choice("-m,--method", "auto", choices(),
                     "Kind of surface; auto: what explains the touches best, weighed against the others. Plane jobs: a "
                     "plane; swept ones: straight along their direction");
        const bool& use_boundary = t.flag(
            "--use-boundary", "Take the anomaly's boundary points as touches, too: those of role 0, else the job's "
                              "that have a z; planes always do");
        const std::string& noise =
            t.choice("--noise", "job", {"job", "estimate"},
                     "Standard deviation of a touch: by the probe's accuracy that the job names, or by the residuals, "
                     "which takes 3 touches more than the surface needs; sigma then is Student's t's. A scan's "
                     "always is by the residuals");
        const std::optional<Units::Length>& file_unit =
            t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
        const std::optional<double>& spacing =
            t.number_if_given("--spacing", "LENGTH",
                              "Griddata: half the shortest wave to keep; 0: do not sample again; else half the "
                              "mean distance of the points",
                              Range::at_least(0));
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json > surface.json",
                  "touch a scanned hammer and fit a free-form surface");
        t.reference("Wang (2007), 4.2 to 4.4; Hoeting et al. (1999), Bayesian model averaging: auto");
        t.parse();

        const Job job = read_job(job_file);
        const std::string source = display_name(points);
        const Units units{file_unit.value_or(job.units.length), job.units.force};
        const CloudStream stream(points, units);
        if (is_dense(stream.points(), job, method)) {
            if (use_boundary && !stream.points().has_roles)
                t.warn("--use-boundary: a scan shows the metal at the boundary itself, the job's points are not added");
            const DenseFit dense = fit_dense(stream.points(), job, use_boundary, source);
            report(t.report(), dense);
            return finish(t, dense.fit, dense.counts.used, dense.counts.ignored());
        }
        FitInput input = fit_input(job, *stream.cloud(), source);
        input.estimate_noise = noise == "estimate";
        if (use_boundary) take_boundary(input);
        if (spacing) input.spacing = *spacing * job.units.mm();
        const Fit fit = fit_surface(input, method);
        report(t.report(), fit);
        name_gross_errors(t, fit, source, job.units);
        warn_of_misfit(t, fit.surface, source);
        return finish(t, fit, static_cast<std::size_t>(fit.surface.touches.cols()),
                      static_cast<std::size_t>(fit.surface.ignored));
    });
}
