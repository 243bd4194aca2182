#include "cli/tool.h"
#include "compare/picture.h"
#include "core/direction.h"
#include "core/file.h"
#include "mesh/shape_file.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(
        argc, argv,
        "Draw an error map or a height map, from above or any direction: PNG with legend, scale bar and histogram.",
        [](Tool& t) {
            const std::string& path = t.input("POINTS", "An error map or a part (PCD), or a mesh (STL, PLY, OBJ, OFF)");
            const std::string& shown =
                t.text("--field", "", "NAME", "What to show: error, z, removed, … [error if there is one, else z]");
            const std::optional<double>& scale = t.number_if_given(
                "--scale", "A", "Colours from -A to A (error), from the least value to A above it (others)",
                Range::positive());
            const int& bands = t.count("--bands", 0, "Colours in so many steps; 0: continuous", 0, 100);
            const std::string& from =
                t.text("--from", "0,0,1", "X,Y,Z",
                       "Towards the eye, in the machine frame; Z is up in the picture, or Y when looking along Z");
            const std::string& title = t.text("--title", "", "TEXT", "Headline");
            const std::string& within =
                t.other_file("--within", "JOB", "Draw this job's B and S; numbers are those inside B");
            const std::optional<Units::Length>& stated =
                t.length_unit("--file-units", "Of POINTS: mm, in, m [as the file says, else the job's, else mm]");
            t.example("fettle-part parts/wang1.json | fettle-render --within jobs/wang1.json -o wang1.png",
                      "the plate with the sloped H, shaded");
            t.reference("Wang 2007, figures 5-10 and 6-12");
            t.parse();

            PictureOptions options;
            options.title = title;
            options.scale = scale;
            options.bands = bands;
            options.from = parse_direction(from, "--from");
            if (!within.empty()) options.within = read_job(within);
            const std::optional<Units> units =
                units_of(stated, options.within ? std::optional(options.within->units) : std::nullopt);
            const ShapeFile file = parse_shape(read_whole(path), display_name(path), units);
            options.units = file.units;
            const Cloud* cloud = std::get_if<Cloud>(&file.shape);
            if (cloud != nullptr && has_field(*cloud, "error")) options.field = "error";
            if (!shown.empty()) options.field = shown;
            named(display_name(path), [&] { t.output() << picture(file.shape, options); });
            return Verdict::yes;
        });
}
