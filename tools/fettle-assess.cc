#include "belt/assess.h"
#include "belt/displaced_normals.h"
#include "belt/surfel.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "core/text.h"

#include <ostream>

using namespace fettle;

namespace {

/// Moves the points to the stock's surface, with its normals.
void displace(cli::Tool& t, cloud::Cloud& cloud, const belt::Surfels& surfels, const std::string& source)
{
    const belt::DisplacedNormals found = belt::displaced_normals(surfels);
    cloud.xyz = belt::displaced_positions(surfels);
    cloud::set_normals(cloud, found.normal);
    t.report()
        .set("largest_bend", found.max_displacement_curvature)
        .set("beyond", found.above_limit)
        .set("undetermined", found.undetermined);
    const std::string of_all = " of " + std::to_string(surfels.size()) + " surfels";
    if (found.above_limit > 0)
        t.warn(source + ": |displacement| times curvature exceeds " +
               core::to_short_text(belt::kMaxDisplacementCurvature) + " at " + std::to_string(found.above_limit) +
               of_all + ": their normals are inaccurate");
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Judge a workpiece of surfels: gouge, within or undercut by their displacements.\n"
        "Out: the surfels with error (the displacement, + material left), class (-1 gouge, 0 within, 1 undercut; NaN: "
        "no displacement) and rgb: bright and dark red, pale green, violet and dark blue, a step for each width of the "
        "range. Lengths in mm. Exit 1 if a surfel is gouged or undercut, or none has a displacement.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& path = t.main_input("SURFELS", "PCD of fettle-surfel or fettle-belt");
        const auto& lower = t.optional_number("--lower", "MM", "Displacements below are gouge; must be given");
        const auto& upper = t.optional_number("--upper", "MM", "Displacements above are undercut; must be given");
        const bool& as_displaced =
            t.flag("--displaced", "The points are those of the stock, with its normals, not the design's");
        const cloud::CloudOutput out{t};
        t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
                  "--stock-units in --spacing 1 | fettle-assess --lower -0.1 --upper 0.1 -o errors.pcd; "
                  "fettle-render errors.pcd -o errors.png",
                  "what a stub leaves over a saddle");
        t.reference("Ren et al. 2006, Grinding error assessment; eq. 4 (normals), with its last product put right");
        t.parse();

        if (!lower || !upper) throw core::InputError("--lower and --upper must be given");
        if (!(*lower <= *upper))
            throw core::InputError("--lower",
                                   core::to_text(*lower) + " is more than --upper, " + core::to_text(*upper));
        const belt::ToleranceRange range = {*lower, *upper};
        cloud::Cloud cloud = cloud::read_cloud(path).cloud;
        if (!cloud::has_field(cloud, "displacement"))
            throw core::InputError(core::display_name(path), "no field displacement");
        const belt::Surfels surfels = belt::surfels_from_cloud(cloud, core::display_name(path));
        t.report() = belt::to_json(surfels, range);
        belt::set_assessment(cloud, surfels.displacement, range);
        if (as_displaced) displace(t, cloud, surfels, core::display_name(path));
        out.write(cloud, units::Units{});
        const belt::AssessmentCounts counts = belt::count_assessments(surfels.displacement, range);
        if (counts.undefined > 0)
            t.warn(core::display_name(path) + ": " + std::to_string(counts.undefined) + " of " +
                   std::to_string(surfels.size()) + " surfels have no displacement");
        return counts.within > 0 && counts.gouge + counts.undercut == 0 ? cli::Verdict::yes : cli::Verdict::no;
    });
}
