#include "station/planning.h"

#include "core/error.h"
#include "fit/fit_file.h"
#include "gantry/touch.h"
#include "job/frame.h"
#include "job/plausible.h"
#include "margin/shift.h"
#include "report/page.h"
#include "sampling/probe.h"

#include <ostream>

namespace fettle::station {
namespace {

surface::Surface fit_samples(const job::Job& job, const std::string& samples, std::vector<std::string>& warnings)
{
    fit::FitRequest request;
    request.points = samples;
    const fit::FitRun run = fit::fit_file(job, request);
    warnings.insert(warnings.end(), run.warnings.begin(), run.warnings.end());
    if (!run.fit.converged) throw core::InputError(samples, "the " + run.fit.surface.method + " fit did not converge");
    return run.fit.surface;
}

void raise_by_margin(surface::Surface& surface, const job::Job& job, const std::string& source,
                     const PlanningOptions& options)
{
    surface.prediction = margin::predict_by_posterior(surface, job, options.confidence, options.seed, source);
    margin::check_determined(*surface.prediction, job, source);
    surface.shift = surface.prediction->shift;
}

void save_page(const Folder& folder)
{
    report::RunFileNames names;
    names.job = folder.file(kJobFile);
    names.samples = folder.file(kSamplesFile);
    names.surface = folder.file(kSurfaceFile);
    names.plan = folder.file(kPlanFile);
    report::RunFiles run = report::read_run(names);
    // The page stays the same where the folder is moved.
    for (report::SourceFile& source : run.sources) source.name = source.name.substr(source.name.rfind('/') + 1);
    folder.save(kPageFile, [&](std::ostream& out) { out << report::report_page(run, "", FETTLE_VERSION); });
}

} // namespace

std::vector<std::string> touch_surface(const Record& record, gantry::Gantry& machine, const Folder& folder,
                                       const PlanningOptions& options,
                                       const std::function<void(const Eigen::Vector3d&)>& touched)
{
    const job::Job& job = record.job;
    folder.save(kJobFile, [&](std::ostream& out) { out << job::to_json(job); });
    gantry::TouchedPart part;
    part.name = "the part";
    part.touch = gantry::GantryProbe(machine, job, record.touches, touched);
    gantry::TouchRequest request;
    request.strategy = options.touches;
    const gantry::JobTouches result = gantry::touch_job(job, &part, request);
    folder.save(kSamplesFile, [&](std::ostream& out) {
        cloud::write_pcd(out, job::in_job_frame(sampling::sample_cloud(result.touches, result.plan, result.order), job),
                         job.units, options.encoding);
    });
    return result.warnings;
}

plan::Plan plan_job(const job::Job& job, const Folder& folder, const PlanningOptions& options,
                    std::vector<std::string>& warnings)
{
    surface::Surface surface = fit_samples(job, folder.file(kSamplesFile), warnings);
    raise_by_margin(surface, job, kSamplesFile, options);
    folder.save(kSurfaceFile, [&](std::ostream& out) { out << surface::to_json(surface); });
    // As fettle-plan reads it: the numbers of a file, and so the bytes of what follows from them.
    const plan::Plan plan = plan::make_plan(job, surface::read_surface(folder.file(kSurfaceFile)));
    folder.save(kPlanFile, [&](std::ostream& out) { out << plan::to_json(plan); });
    save_page(folder);
    return plan::read_plan(folder.file(kPlanFile));
}

} // namespace fettle::station
