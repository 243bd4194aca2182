#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "mesh/mesh_file.h"
#include "surface/surface_grid.h"

#include <ostream>

using namespace fettle;

namespace {

/// x, y with the surface's z and, if wanted, its standard deviation.
Cloud evaluate(const Surface& surface, const Eigen::Matrix2Xd& xy, bool with_sigma)
{
    Cloud cloud;
    cloud.xyz.resize(3, xy.cols());
    cloud.xyz << xy, heights(surface, xy).transpose();
    if (!with_sigma) return cloud;
    set_field(cloud, "sigma", sigmas(surface, xy));
    return cloud;
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Evaluate a surface at given points or on a grid.", [](Tool& t) {
        const std::string& surface_file = t.input("SURFACE", "Fitted surface, JSON");
        const std::string& at =
            t.other_file("--at", "FILE", "Points, PCD: their x y get the surface's z, in their order");
        const std::optional<Units::Length>& at_units =
            t.length_unit("--at-units", "Unit of the points, if not the surface's");
        const std::optional<double>& step =
            t.number_if_given("--step", "LENGTH", "Spacing of a grid", Range::positive());
        const std::string& within =
            t.other_file("--within", "JOB",
                         "The grid covers the job's anomaly, along W, in the job's units; else the "
                         "touches' bounding box");
        const bool& with_sigma = t.flag("--sigma", "Add the height's standard deviation as field sigma");
        const bool& stl = t.flag("--stl", "Write the grid as triangles, STL");
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json | fettle-mesh "
                  "--step 1 --within jobs/hammer.json --sigma > grid.pcd",
                  "heights beneath the anomaly of a scanned hammer, every 1 mm");
        t.reference("standard deviation: of a linear function of the fit's parameters, gᵀ C g");
        t.parse();

        if (at.empty() == !step.has_value()) throw InputError("give either --at POINTS or --step LENGTH");
        if (!at.empty() && (stl || !within.empty())) throw InputError("--within and --stl belong to --step");
        if (at == "-" && surface_file == "-") throw InputError("only one of SURFACE and --at can be stdin");
        if (stl && with_sigma) throw InputError("--sigma: an STL has no place for it");
        const Surface surface = read_surface(surface_file);
        if (with_sigma && !knows_sigma(surface))
            throw InputError(display_name(surface_file), "has no covariance, so --sigma is not known");

        Units units = surface.units;
        if (!at.empty()) {
            const Units point_units = at_units ? Units{*at_units, units.force} : units;
            const Eigen::Matrix2Xd xy = read_cloud(at, point_units).cloud.xyz.topRows(2);
            write_pcd(t.output(), evaluate(surface, xy, with_sigma), units);
            return Verdict::yes;
        }
        Polygon outline;
        double angle = 0;
        if (within.empty()) {
            outline = touched_box(surface, display_name(surface_file));
        } else {
            const Job job = read_job(within);
            units = job.units;
            angle = job.theta;
            outline = boundaries(job).anomaly;
        }
        SurfaceGrid grid;
        try {
            grid = grid_over(outline, angle, *step * units.mm());
        } catch (const InputError& error) {
            throw InputError("--step", error.what());
        }
        t.report().set("points", static_cast<int>(grid.xy.cols()));
        if (stl)
            write_stl(t.output(), mesh_of(surface, grid), units.length);
        else
            write_pcd(t.output(), evaluate(surface, grid.xy, with_sigma), units);
        return Verdict::yes;
    });
}
