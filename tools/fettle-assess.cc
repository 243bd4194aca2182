#include "belt/assess.h"
#include "belt/displaced_normals.h"
#include "belt/surfel.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "core/text.h"

#include <ostream>

using namespace fettle;

namespace {

/// Moves the points to the stock's surface, with its normals.
void displace(Tool& t, Cloud& cloud, const Surfels& surfels, const std::string& source)
{
    const DisplacedNormals found = displaced_normals(surfels);
    cloud.xyz = displaced(surfels);
    set_normals(cloud, found.normal);
    t.report()
        .set("largest_bend", found.largest_bend)
        .set("beyond", static_cast<std::size_t>(found.beyond))
        .set("undetermined", static_cast<std::size_t>(found.undetermined));
    const std::string of_all = " of " + std::to_string(surfels.size()) + " surfels";
    if (found.beyond > 0)
        t.warn(source + ": |displacement| times curvature exceeds " + to_short_text(kLargestBend) + " at " +
               std::to_string(found.beyond) + of_all + ": their normals are rough");
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Judges a workpiece of surfels: gouge, within or undercut by their displacements.\n"
        "Out: the surfels with error (the displacement, + material left), class (-1 gouge, 0 within, 1 undercut; NaN: "
        "no displacement) and rgb: bright and dark red, pale green, violet and dark blue, a step for each width of the "
        "range. Lengths in mm. Exit 1 if a surfel is gouged or undercut, or none has a displacement.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path = t.input("SURFELS", "Of fettle-surfel or fettle-belt, PCD");
        const auto& lower = t.number_if_given("--lower", "MM", "Displacements below are gouge; must be given");
        const auto& upper = t.number_if_given("--upper", "MM", "Displacements above are undercut; must be given");
        const bool& as_displaced =
            t.flag("--displaced", "The points are those of the stock, with its normals, not the design's");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
                  "--stock-units in --spacing 1 | fettle-assess --lower -0.1 --upper 0.1 -o errors.pcd; "
                  "fettle-render errors.pcd -o errors.png",
                  "what a stub leaves over a saddle");
        t.reference("Ren et al. 2006, Grinding error assessment; eq. 4 (normals), with its last product put right");
        t.parse();

        if (!lower || !upper) throw InputError("--lower and --upper must be given");
        if (!(*lower <= *upper))
            throw InputError("--lower", to_text(*lower) + " is more than --upper, " + to_text(*upper));
        const ToleranceRange range = {*lower, *upper};
        Cloud cloud = read_cloud(path, Units{}).cloud;
        if (!has_field(cloud, "displacement")) throw InputError(display_name(path), "no field displacement");
        const Surfels surfels = surfels_of(cloud, display_name(path));
        t.report() = to_json(surfels, range);
        set_assessment(cloud, surfels.displacement, range);
        if (as_displaced) displace(t, cloud, surfels, display_name(path));
        write_pcd(t.output(), cloud, Units{}, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        const AssessmentCounts counts = count(surfels.displacement, range);
        if (counts.undefined > 0)
            t.warn(display_name(path) + ": " + std::to_string(counts.undefined) + " of " +
                   std::to_string(surfels.size()) + " surfels have no displacement");
        return counts.within > 0 && counts.gouge + counts.undercut == 0 ? Verdict::yes : Verdict::no;
    });
}
