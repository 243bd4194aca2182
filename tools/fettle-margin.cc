#include "cli/tool.h"
#include "core/file.h"
#include "job/job.h"
#include "margin/shift.h"
#include "surface/surface.h"

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(
        argc, argv, "Predict the error band of a fitted surface and raise it so that nothing is over-ground.",
        [](Tool& t) {
            const std::string& method = t.choice("--method", "posterior", {"posterior", "wang"},
                                                 "the fit's own covariance, or Wang's regressions");
            const double& confidence =
                t.number("--confidence", 0.99, "SHARE",
                         "Posterior: that all of the anomaly stays above the true surface", Range::inside(0, 1));
            const std::string& job_file = t.file("JOB", "Job, JSON");
            const std::string& surface_file = t.input("SURFACE", "Fitted surface, JSON");
            t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json | "
                      "fettle-margin jobs/hammer.json > desired.json",
                      "touch a scanned hammer, fit it, and raise the fit by its 99 % shift");
            t.reference("Wang 2007, eq. 4-1 (error band), eq. 4-6 (shift distance) and 4.5 (regressions)");
            t.parse();

            const Job job = read_job(job_file);
            const std::string name = display_name(surface_file);
            Surface surface = read_surface(surface_file);
            surface.prediction = method == "wang" ? predict_by_regression(surface, job, name)
                                                  : predict_by_posterior(surface, job, confidence, t.seed(), name);
            surface.shift = surface.prediction->shift;
            if (surface.prediction->clamped)
                t.warn(job_file + ": a regression fell below the probe's accuracy, which is used instead");

            const double mm = job.units.mm();
            t.report()
                .set("method", method)
                .set("confidence", surface.prediction->confidence)
                .set("predicted_band", surface.prediction->band / mm)
                .set("shift", surface.prediction->shift / mm)
                .set("clamped", surface.prediction->clamped);
            t.output() << to_json(surface);
            return Verdict::yes;
        });
}
