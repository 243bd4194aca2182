#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/picture.h"
#include "core/direction.h"
#include "core/file.h"
#include "mesh/mesh_file.h"

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
            std::optional<Units> units;
            if (options.within) units = options.within->units;
            if (stated) units = Units{*stated, units.value_or(Units{}).force};

            const std::string bytes = read_whole(path);
            const std::string source = display_name(path);
            std::variant<Cloud, Mesh> part;
            if (looks_like_cloud(bytes)) {
                CloudFile file = parse_cloud(bytes, source, units);
                options.units = file.units;
                options.field = !shown.empty() ? shown : has_field(file.cloud, "error") ? "error" : "z";
                part = std::move(file.cloud);
            } else {
                options.units = units.value_or(Units{});
                if (!shown.empty()) options.field = shown;
                part = parse_mesh(bytes, source, options.units.length);
            }
            try {
                t.output() << picture(part, options);
            } catch (const InputError& error) {
                throw InputError(source, error.what());
            }
            return Verdict::yes;
        });
}
