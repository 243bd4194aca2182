#include "cli/tool.h"
#include "core/error.h"
#include "core/file.h"
#include "job/job.h"
#include "job/plausible.h"
#include "margin/scan_waves.h"
#include "margin/shift.h"
#include "sampling/scan.h"
#include "surface/surface.h"

#include <optional>
#include <string>

using namespace fettle;

namespace {

Eigen::Matrix3Xd read_heights(cli::Tool& t, const std::string& file, const job::Job& job,
                              std::optional<units::Units::Length> unit)
{
    const sampling::Scan scan = sampling::read_scan(file, job, unit);
    const std::string name = core::display_name(file);
    for (const std::string& doubt : sampling::scan_warnings(scan, job, name)) t.warn(doubt);
    return margin::heights_around_anomaly(scan, job, name);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Predict the error band of a fitted surface and raise it so that nothing is over-ground.",
        [](cli::Tool& t) {
            const std::string& method = t.choice("--method", "posterior", {"posterior", "wang"},
                                                 "the fit's own covariance, or Wang's regressions");
            const double& confidence = t.number("--confidence", 0.99, "SHARE",
                                                "Posterior: that all of the anomaly stays above the true surface",
                                                core::Range::strictly_between(0, 1));
            const margin::PlaneShift& plane_shift = t.choice<margin::PlaneShift>(
                "--plane-shift",
                {{"worst-case", margin::PlaneShift::worst_case}, {"accuracy", margin::PlaneShift::accuracy}},
                "Wang's method, planes: the worst case of all touches, or the probe's accuracy as he published");
            const std::string& scan_file =
                t.optional_file("--scan", "FILE",
                                "Posterior: scan of the part, mesh or cloud, in the part's frame. Its metal around the "
                                "anomaly says how large the waves are that few touches do not show");
            const auto& scan_unit = t.length_unit("--scan-units", "Unit of that file, if it is not the job's");
            const std::string& job_file = t.positional_file("JOB", "Job, JSON");
            const std::string& surface_file = t.main_input("SURFACE", "Fitted surface, JSON");
            t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json | "
                      "fettle-margin jobs/hammer.json > desired.json",
                      "touch a scanned hammer, fit it, and raise the fit by its 99 % shift");
            t.reference("Wang 2007, eq. 4-1 (error band), eq. 4-6 (shift distance) and 4.5 (regressions)");
            t.output_formats({"json"});
            t.parse();

            if (method != "wang" && plane_shift != margin::PlaneShift::worst_case)
                throw core::InputError("--plane-shift is for --method wang");
            if (method == "wang" && !scan_file.empty()) throw core::InputError("--scan is for --method posterior");
            if (scan_unit && scan_file.empty()) throw core::InputError("--scan-units goes with --scan");
            const job::Job job = job::read_job(job_file);
            const std::string name = core::display_name(surface_file);
            surface::Surface surface = surface::read_surface(surface_file);
            job::check_touch_places({surface.touches, surface.roles}, job, name);
            const Eigen::Matrix3Xd around =
                scan_file.empty() ? Eigen::Matrix3Xd() : read_heights(t, scan_file, job, scan_unit);
            surface.prediction = method == "wang" ? margin::predict_by_regression(surface, job, name, plane_shift)
                                                  : margin::predict_by_posterior(surface, job, confidence, t.seed(),
                                                                                 name, margin::Tails::student, around);
            margin::check_determined(*surface.prediction, job, name);
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
            t.output() << surface::to_json(surface);
            return cli::Verdict::yes;
        });
}
