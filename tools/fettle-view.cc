#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "job/frame.h"
#include "job/job.h"
#include "job/shape_warnings.h"
#include "view/view.h"

#include <algorithm>
#include <filesystem>
#include <ostream>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::vector<std::string>& files = t.positional_files(
        "PART",
        "Clouds with their fields (PCD, PLY, E57, PTX, XYZ) and meshes (STL, PLY, OBJ, OFF, 3MF): a layer each");
    const std::string& fields =
        t.text("--field", "", "NAME,...",
               "What to show: error, z, class, rgb, sigma, … [error if there is one, else z; and class]");
    const std::optional<double>& scale = t.optional_number(
        "--scale", "A", "Colours from -A to A (error), from the smallest value to A above it (others)",
        core::Range::positive());
    const int& bands = t.count("--bands", 0, "Colours in so many steps; 0: continuous", 0, 100);
    const draw::Palette& palette = t.choice("--palette", draw::kPalettes, draw::kPaletteHelp);
    const std::string& within =
        t.optional_file("--within", "JOB", "Draw this job's B and S on the part; numbers are those inside B");
    const std::string& touches = t.optional_file("--touches", "POINTS", "Draw these points as dots, PCD");
    const std::string& title = t.text("--title", "", "TEXT", "Headline");
    const bool& pick = t.flag("--pick", "Clicks on the part set the corners of B and S, which fettle-teach reads");
    const std::optional<units::Units::Length>& file_units =
        t.length_unit("--file-units", "Unit of PART: mm, in, m [as the file says, else the job's, else mm]");
    const std::optional<units::Units::Length>& units =
        t.length_unit("--units", "Unit of the page's numbers [that of PART, mm for metres]");
};

/// The fields of a layer that are shown: of those that were asked for, the ones it has, or z.
std::vector<std::string> fields_of(const cloud::Cloud& points, const std::vector<std::string>& wanted)
{
    if (wanted.empty()) return view::default_fields(points);
    std::vector<std::string> fields;
    for (const std::string& name : wanted)
        if (name == "z" || cloud::has_field(points, name)) fields.push_back(name);
    if (fields.empty()) fields.emplace_back("z");
    return fields;
}

std::vector<std::string> split_names(const std::string& list)
{
    std::vector<std::string> names;
    for (std::size_t from = 0; from < list.size();) {
        const std::size_t comma = std::min(list.find(',', from), list.size());
        if (comma > from) names.push_back(list.substr(from, comma - from));
        from = comma + 1;
    }
    return names;
}

std::optional<units::Units> stated_units(const Options& o, const view::ViewOptions& options)
{
    return mesh::resolve_file_units(o.file_units,
                                    options.picture.job ? std::optional(options.picture.job->units) : std::nullopt);
}

std::vector<view::Layer> read_layers(const Options& o, view::ViewOptions& options)
{
    const std::vector<std::string> wanted = split_names(o.fields);
    const std::optional<units::Units> units = stated_units(o, options);
    std::vector<view::Layer> layers;
    for (const std::string& path : o.files) {
        mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, units);
        if (layers.empty()) {
            options.picture.units = cloud::measured_units(
                file.units, options.picture.job ? std::optional(options.picture.job->units) : std::nullopt);
            if (o.units) options.picture.units.length = *o.units;
        }
        const std::string name = core::display_name(path);
        for (const std::string& warning : job::shape_warnings(file, name)) o.t.warn(warning);
        if (options.picture.job) job::move_to_job_frame(file.part.points, *options.picture.job);
        const std::vector<std::string> fields = fields_of(file.part.points, wanted);
        layers.push_back({std::filesystem::path(name).filename().string(), std::move(file.part), fields});
    }
    for (const std::string& field : wanted)
        if (std::ranges::none_of(layers,
                                 [&](const view::Layer& layer) { return std::ranges::count(layer.fields, field) > 0; }))
            throw core::InputError("--field", "no file has a field '" + field + "'");
    return layers;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv,
        "Make a page with a view that turns: parts, error maps and other fields, sections; or to pick corners.",
        [](cli::Tool& t) {
            const Options o{t};
            t.example("fettle-part parts/wang1.json | fettle-view - --within jobs/wang1.json -o view.html",
                      "the plate with the sloped H and its boundaries, to be turned");
            t.reference("Wang 2007, 3.2: the operator marks the boundaries of an anomaly");
            t.output_formats({"html"});
            t.parse();
            view::ViewOptions options;
            if (!o.within.empty()) options.picture.job = job::read_job(o.within);
            options.picture.scale = o.scale;
            options.picture.bands = o.bands;
            options.picture.palette = o.palette;
            options.pick = o.pick;
            const std::vector<view::Layer> layers = read_layers(o, options);
            if (!o.touches.empty()) {
                mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.touches, stated_units(o, options));
                if (options.picture.job) job::move_to_job_frame(file.part.points, *options.picture.job);
                options.touches = file.part.points.xyz;
            }
            t.output() << view::view_page(layers, options, o.title);
            return cli::Verdict::yes;
        });
}
