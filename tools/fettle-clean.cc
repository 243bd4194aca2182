#include "clean/clean.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "core/file.h"
#include "core/text.h"
#include "job/shape_warnings.h"
#include "mesh/part_output.h"
#include "mesh/read_formats.h"
#include "mesh/shape_file.h"

using namespace fettle;

namespace {

constexpr int kMaxNeighbours = 1000; // of a point: more do not say more, and take time

/// The parts of "NAME:A,B" after the colon; nothing for another name.
std::optional<std::vector<std::string>> arguments_of(const std::string& text, const std::string& name,
                                                     std::size_t count)
{
    if (!text.starts_with(name + ':')) return std::nullopt;
    std::vector<std::string> arguments = cli::split_list(text.substr(name.size() + 1));
    if (arguments.size() != count)
        throw core::InputError("expected " + std::to_string(count) + " numbers after " + name + ":, got '" + text +
                               "'");
    return arguments;
}

/// @param mm  millimetres in the unit of lengths
clean::OutlierFilter parse_outliers(const std::string& text, double mm)
{
    const auto neighbours = [](const std::string& word) {
        return static_cast<int>(cli::parse_integer_in(word, 1, kMaxNeighbours));
    };
    if (const auto words = arguments_of(text, "statistical", 2))
        return clean::StatisticalFilter{neighbours(words->at(0)),
                                        cli::parse_number_in(words->at(1), core::Range::at_least(0))};
    if (const auto words = arguments_of(text, "radius", 2))
        return clean::RadiusFilter{mm * cli::parse_number_in(words->at(0), core::Range::positive()),
                                   neighbours(words->at(1))};
    throw core::InputError("expected statistical:K,S or radius:R,N, got '" + text + "'");
}

clean::Thinning parse_thinning(const std::string& text, double mm)
{
    using Rule = clean::Thinning::Rule;
    const auto words = arguments_of(text, "spacing", 1);
    const std::string& length = words ? words->front() : text;
    return {words ? Rule::spacing : Rule::voxel, mm * cli::parse_number_in(length, core::Range::positive())};
}

Eigen::Vector3d parse_direction(const std::string& text)
{
    const std::vector<std::string> words = cli::split_list(text);
    if (words.size() != 3) throw core::InputError("expected X,Y,Z, got '" + text + "'");
    Eigen::Vector3d direction;
    for (int k = 0; k < 3; ++k) direction[k] = cli::parse_number_in(words[k], {});
    if (!(direction.norm() > 0)) throw core::InputError("a direction is not 0,0,0");
    return direction.stableNormalized();
}

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("IN", mesh::kReadFormats);
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of IN, if it states none; default: mm, or the unit of the job of --crop");
    const std::string& crop =
        t.text("--crop", "", "REGION",
               "Leave out what lies outside of box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,RADIUS, "
               "polygon:Z0,Z1,X1,Y1,X2,Y2,X3,Y3,…, or the sampling boundary of a JOB, at any height");
    const std::string& facing =
        t.text("--facing", "", "X,Y,Z",
               "Leave out what faces away from this direction, by a cloud's normals or a mesh's "
               "triangles: 0,0,1 leaves out undersides");
    const std::string& outliers =
        t.text("--outliers", "", "FILTER",
               "statistical:K,S leaves out points whose mean distance to K neighbours exceeds that of all points by S "
               "standard deviations; radius:R,N those with fewer than N others within R");
    const std::string& thinning =
        t.text("--thin", "", "LENGTH",
               "Keep one point, as it was measured, of each cube with this edge: the one nearest to their mean; with "
               "spacing:LENGTH, points no nearer to each other than that");
    const bool& keeps_organised = t.flag(
        "--keep-organised", "Keep the rows and columns of an organised cloud (PCD, PTX): what is left out leaves "
                            "NaN at its place");
    const mesh::PartOutput out{t};
};

clean::StatedRegion parse_crop(const std::string& text)
{
    return cli::with_error_prefix("--crop", [&] { return clean::parse_region(text); });
}

/// The filters, in the unit of the file. What can be checked before a large file is read is.
clean::CleanRequest parse_request(const Options& o, double mm)
{
    clean::CleanRequest request;
    request.keeps_organised = o.keeps_organised;
    const auto parse = [](const std::string& name, const std::string& text, const auto& parser) {
        return cli::with_error_prefix(name, [&] { return parser(text); });
    };
    if (!o.crop.empty()) {
        const clean::StatedRegion stated = parse_crop(o.crop);
        request.crop = clean::scaled(stated.region, stated.job_units ? 1 : mm);
    }
    if (!o.facing.empty()) request.facing = parse("--facing", o.facing, parse_direction);
    if (!o.outliers.empty())
        request.outliers = parse("--outliers", o.outliers, [&](const auto& text) { return parse_outliers(text, mm); });
    if (!o.thinning.empty())
        request.thinning = parse("--thin", o.thinning, [&](const auto& text) { return parse_thinning(text, mm); });
    return request;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Clean a raw scan: take away what is no part, and change nothing that stays.\n"
        "Points that are not finite, several points at exactly (0, 0, 0), points where another one is, and triangles "
        "drawn twice always go; then what the options name, in the order crop, facing, outliers, thin. Points keep "
        "their order and all their fields; a triangle stays if its three corners do. The report counts what each "
        "filter took away.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-clean scans/hammer.stl --crop jobs/hammer.json --facing 0,0,1 -o cheek.stl",
                  "the hammer's cheek around its weld bead, without undersides");
        t.reference(
            "Rusu et al. 2008 (statistical outliers); PCL's StatisticalOutlierRemoval and RadiusOutlierRemoval");
        t.parse();
        parse_request(o, 1);
        const std::optional<units::Units> job_units = o.crop.empty() ? std::nullopt : parse_crop(o.crop).job_units;

        mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.path, mesh::resolve_file_units(o.unit, job_units));
        const std::string name = core::display_name(o.path);
        o.out.format_for(file.part.is_mesh());
        for (const std::string& warning : job::shape_warnings(file, name)) t.warn(warning);

        t.report().set("points", file.part.points.size()).set("triangles", file.part.triangles.cols());
        const clean::CleanResult result = cli::with_error_prefix(
            name, [&] { return clean::clean_part(std::move(file.part), parse_request(o, file.units.mm())); });
        for (const clean::FilterCount& filter : result.filters) t.report().set(filter.name, filter.removed);
        t.report().set("points_left", result.points_left).set("triangles_left", result.part.triangles.cols());
        o.out.write(result.part, file.units);
        return cli::Verdict::yes;
    });
}
