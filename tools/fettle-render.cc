#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/direction.h"
#include "core/file.h"
#include "draw/picture.h"
#include "job/frame.h"
#include "job/shape_warnings.h"
#include "mesh/cloud_mesh.h"
#include "mesh/shape_file.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv,
        "Draw an error map or a height map, from above or any direction: PNG with legend, scale bar and histogram.",
        [](cli::Tool& t) {
            const std::string& path =
                t.main_input("POINTS", "An error map or a part (PCD), or a mesh (STL, PLY, OBJ, OFF)");
            const std::string& shown =
                t.text("--field", "", "NAME",
                       "What to show: error, z, class, rgb, removed, … [error if there is one, else z]");
            const std::optional<double>& scale = t.optional_number(
                "--scale", "A", "Colours from -A to A (error), from the smallest value to A above it (others)",
                core::Range::positive());
            const int& bands = t.count("--bands", 0, "Colours in so many steps; 0: continuous", 0, 100);
            const draw::Palette& palette = t.choice("--palette", draw::kPalettes, draw::kPaletteHelp);
            const std::string& from =
                t.text("--from", "0,0,1", "X,Y,Z",
                       "Towards the eye, in the machine frame; Z is up in the picture, or Y when looking along Z");
            const std::string& title = t.text("--title", "", "TEXT", "Headline");
            const std::string& within =
                t.optional_file("--within", "JOB", "Draw this job's B and S; numbers are those inside B");
            const std::optional<units::Units::Length>& stated =
                t.length_unit("--file-units", "Unit of POINTS: mm, in, m [as the file says, else the job's, else mm]");
            const std::optional<units::Units::Length>& written =
                t.length_unit("--units", "Unit of the picture's numbers [that of POINTS, mm for metres]");
            t.example("fettle-part parts/wang1.json | fettle-render --within jobs/wang1.json -o wang1.png",
                      "the plate with the sloped H, shaded");
            t.reference("Wang 2007, figures 5-10 and 6-12");
            t.output_formats({"png"});
            t.parse();

            draw::PictureOptions options;
            options.title = title;
            options.scale = scale;
            options.bands = bands;
            options.palette = palette;
            options.towards_eye = core::parse_direction(from, "--from");
            if (!within.empty()) options.job = job::read_job(within);
            const std::optional<units::Units> units =
                mesh::resolve_file_units(stated, options.job ? std::optional(options.job->units) : std::nullopt);
            mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, units);
            if (options.job) job::move_to_job_frame(file.part.points, *options.job);
            options.units =
                cloud::measured_units(file.units, options.job ? std::optional(options.job->units) : std::nullopt);
            if (written) options.units.length = *written;
            if (cloud::has_field(file.part.points, "error")) options.field = "error";
            if (!shown.empty()) options.field = shown;
            cli::with_error_prefix(core::display_name(path), [&] { t.output() << draw::picture(file.part, options); });
            for (const std::string& warning : job::shape_warnings(file, core::display_name(path))) t.warn(warning);
            return cli::Verdict::yes;
        });
}
