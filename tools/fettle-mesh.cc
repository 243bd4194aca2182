#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "mesh/part_output.h"
#include "mesh/shape_file.h"
#include "surface/surface_grid.h"

#include <ostream>

using namespace fettle;

namespace {

/// x, y with the surface's z and, if wanted, its standard deviation.
cloud::Cloud evaluate(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, bool with_sigma)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, xy.cols());
    cloud.xyz << xy, surface::heights(surface, xy).transpose();
    if (!with_sigma) return cloud;
    cloud::set_field(cloud, "sigma", surface::sigmas(surface, xy));
    return cloud;
}

/// A grid over the anomaly of a job, in the job's units, or without one over the touches, in the surface's.
struct GridInUnits {
    surface::SurfaceGrid grid;
    units::Units units;
    cloud::Frame frame;
};

GridInUnits make_grid(const surface::Surface& surface, const std::string& source, const std::string& job_file,
                      double step)
{
    units::Units units = surface.units;
    job::Polygon outline;
    cloud::Frame frame = cloud::Frame::part;
    double angle = 0;
    if (job_file.empty()) {
        outline = surface::touch_bounding_box(surface, source);
    } else {
        const job::Job job = job::read_job(job_file);
        units = job.units;
        frame = job.frame();
        angle = job.theta;
        outline = job::working_boundaries(job).anomaly;
    }
    return {
        cli::with_error_prefix("--step", [&] { return surface::make_surface_grid(outline, angle, step * units.mm()); }),
        units, frame};
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Evaluate a surface at given points or on a grid.", [](cli::Tool& t) {
        const std::string& surface_file = t.main_input("SURFACE", "Fitted surface, JSON");
        const std::string& at =
            t.optional_file("--at", "FILE", "Points: their x y get the surface's z, in their order");
        const std::optional<units::Units::Length>& at_units =
            t.length_unit("--at-units", "Unit of the points, if not the surface's");
        const std::optional<double>& step =
            t.optional_number("--step", "LENGTH", "Spacing of a grid", core::Range::positive());
        const std::string& within =
            t.optional_file("--within", "JOB",
                            "The grid covers the job's anomaly, along W, in the job's units; else the "
                            "touches' bounding box");
        const bool& with_sigma = t.flag("--sigma", "Add the height's standard deviation as field sigma");
        const bool& stl = t.flag("--stl", "Write the grid as triangles, STL or PLY");
        const mesh::PartOutput out{t};
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json | fettle-mesh "
                  "--step 1 --within jobs/hammer.json --sigma > grid.pcd",
                  "heights beneath the anomaly of a scanned hammer, every 1 mm");
        t.reference("standard deviation: of a linear function of the fit's parameters, gᵀ C g");
        t.parse();

        if (at.empty() == !step.has_value()) throw core::InputError("give either --at POINTS or --step LENGTH");
        if (!at.empty() && (stl || !within.empty())) throw core::InputError("--within and --stl belong to --step");
        if (at == "-" && surface_file == "-") throw core::InputError("only one of SURFACE and --at can be stdin");
        if (stl && with_sigma) throw core::InputError("--sigma: an STL has no place for it");
        const surface::Surface surface = surface::read_surface(surface_file);
        if (with_sigma && !surface::has_sigma(surface))
            throw core::InputError(core::display_name(surface_file),
                                   surface::has_touch_noise_only(surface)
                                       ? "the covariance of an interpolant (" + surface.method +
                                             ") holds the touches' noise, not what it misses between them, so --sigma "
                                             "is not known"
                                       : "has no covariance, so --sigma is not known");

        if (!at.empty()) {
            const units::Units point_units{at_units.value_or(surface.units.length), surface.units.force};
            const cloud::Cloud given = cloud::read_cloud(at, point_units).cloud;
            cloud::Cloud points = evaluate(surface, given.xyz.topRows(2), with_sigma);
            points.frame = given.frame;
            out.write({points, {}}, surface.units);
            return cli::Verdict::yes;
        }
        const auto [grid, units, frame] = make_grid(surface, core::display_name(surface_file), within, *step);
        t.report().set("points", static_cast<int>(grid.xy.cols()));
        if (stl) {
            mesh::Mesh triangles = surface::mesh_of(surface, grid);
            triangles.frame = frame;
            out.write(mesh::as_cloud_mesh(triangles), units);
        } else {
            cloud::Cloud points = evaluate(surface, grid.xy, with_sigma);
            points.frame = frame;
            out.write({points, {}}, units);
        }
        return cli::Verdict::yes;
    });
}
