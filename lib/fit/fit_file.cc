#include "fit/fit_file.h"

#include "cloud/point_source.h"
#include "core/error.h"
#include "core/file.h"
#include "fit/input.h"
#include "fit/report.h"
#include "fit/scan_fit.h"
#include "job/frame.h"
#include "job/plausible.h"

namespace fettle::fit {

namespace {

/// Whether the surface was fitted to boundary points of the job, too: griddata and --use-boundary take them as touches.
bool has_boundary_points(const Eigen::Matrix3Xd& touches, const job::Job& job)
{
    constexpr double kMaxCopyDistance = 1e-6; // mm: the points are copies, rounded at most by a change of units
    const auto is_touch = [&](const Eigen::Vector3d& point) {
        return (touches.colwise() - point).colwise().squaredNorm().minCoeff() < kMaxCopyDistance * kMaxCopyDistance;
    };
    for (const Eigen::Matrix3Xd* boundary : {&job.anomaly, &job.sampling})
        for (const Eigen::Vector3d& point : boundary->colwise())
            if (point.allFinite() && is_touch(point)) return true;
    return false;
}

/// Checks the heights of the job's boundary points against the touches. Where they shaped the surface they are refused;
/// else nothing depends on them, and a warning is added to the run's.
void check_boundary_heights(FitRun& run, const job::Job& job, const std::string& name)
{
    const std::string doubt = job::boundary_height_warning({run.fit.surface.touches, run.fit.surface.roles}, job);
    if (doubt.empty()) return;
    if (has_boundary_points(run.fit.surface.touches, job))
        throw core::InputError(name, doubt + " The fit takes them as touches");
    run.warnings.push_back(name + ": " + doubt);
}

/// Checks the fit's touches against the job, and adds the warnings to the run's.
void check_touches(FitRun& run, const job::Job& job, const std::string& name)
{
    const job::PlacedTouches touches{run.fit.surface.touches, run.fit.surface.roles};
    const std::string warning = job::check_touch_places(touches, job, name);
    if (!warning.empty()) run.warnings.push_back(name + ": " + warning);
    check_boundary_heights(run, job, name);
}

/// Checks the fit of a scan likewise. Its condensed touches are the middles of cells, which may lie a little outside S
/// where no point does.
void check_scan(FitRun& run, const job::Job& job, bool is_scan, const std::string& name)
{
    const job::PlacedTouches touches{run.fit.surface.touches, run.fit.surface.roles};
    if (!is_scan) job::check_touch_places(touches, job, name); // of a scan, points outside S are left out
    check_boundary_heights(run, job, name);
}

/// Points without roles as touches near the anomaly, so that none is left out by its place.
cloud::PointSource with_sample_roles(cloud::PointSource points)
{
    points.has_roles = true;
    points.read = [read = points.read](std::size_t first, std::size_t count, cloud::PointBlock& into) {
        read(first, count, into);
        into.roles.setOnes(static_cast<Eigen::Index>(count));
    };
    return points;
}

FitRun run_scan_fit(const cloud::PointSource& points, const job::Job& job, const FitRequest& request, bool is_scan,
                    const std::string& name)
{
    FitRun run;
    run.report.set("as", is_scan ? "scan" : "touches");
    if (request.use_boundary && !points.has_roles)
        run.warnings.emplace_back(
            "--use-boundary: a scan shows the metal at the boundary itself, the job's points are not added");
    const bool needs_roles = !is_scan && !points.has_roles;
    const DenseFit dense = fit_scan(needs_roles ? with_sample_roles(points) : points, job,
                                    {request.use_boundary, is_scan}, request.method, name);
    report(run.report, dense);
    for (const std::string& warning : warnings(dense, job, name)) run.warnings.push_back(warning);
    run.fit = dense.fit;
    check_scan(run, job, is_scan, name);
    run.touches = dense.counts.used;
    run.ignored = dense.counts.ignored();
    return run;
}

/// All points, in the job's frame: normals are turned whole, of which a stream has z alone.
std::shared_ptr<const cloud::Cloud> moved_to_job_frame(const cloud::CloudStream& stream, const job::Job& job)
{
    cloud::Cloud cloud = *stream.read_all();
    job::move_to_job_frame(cloud, job);
    return std::make_shared<const cloud::Cloud>(std::move(cloud));
}

} // namespace

FitRun fit_file(const job::Job& job, const FitRequest& request)
{
    const std::string name = core::display_name(request.points);
    const cloud::CloudStream stream(request.points,
                                    units::Units{request.point_unit.value_or(job.units.length), job.units.force});
    const std::shared_ptr<const cloud::Cloud> moved =
        job::must_be_moved(stream.frame(), job) ? moved_to_job_frame(stream, job) : nullptr;
    const cloud::PointSource points = moved ? cloud::make_point_source(moved) : stream.points();
    const bool is_scan = request.kind == PointKind::scan || (request.kind == PointKind::by_roles && !points.has_roles);
    if (is_scan || points.points > kMaxExactTouches) return run_scan_fit(points, job, request, is_scan, name);

    FitInput input = fit_input(job, moved ? *moved : *stream.read_all(), name);
    input.estimate_noise = request.estimate_noise;
    if (request.use_boundary) add_boundary_touches(input);
    if (request.spacing) input.spacing = *request.spacing * job.units.mm();
    FitRun run;
    run.fit = fit_surface(input, request.method);
    run.touches = static_cast<std::size_t>(run.fit.surface.touches.cols());
    run.ignored = static_cast<std::size_t>(run.fit.surface.ignored);
    run.report.set("as", "touches");
    report(run.report, run.fit);
    run.warnings = warnings(run.fit, name);
    check_touches(run, job, name);
    return run;
}

} // namespace fettle::fit
