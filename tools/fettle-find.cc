#include "align/rigid.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "core/file.h"
#include "find/find.h"
#include "find/registration.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

using namespace fettle;

namespace {

constexpr int kMaxRows = 1000000;

std::vector<int> parse_rows(const std::string& option, const std::string& text)
{
    std::vector<int> rows;
    if (text.empty()) return rows;
    return cli::with_error_prefix(option, [&] {
        for (const std::string& word : cli::split_list(text))
            rows.push_back(static_cast<int>(cli::parse_integer_in(word, 1, kMaxRows)));
        return rows;
    });
}

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("PART", "A cloud (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF)");
    const std::optional<units::Units::Length>& unit = t.length_unit("--file-units", "Unit of PART, if it states none");
    const std::string& against =
        t.optional_file("--against", "REF",
                        "A mesh or cloud of the part as it should be, or of a good part: departures from it are "
                        "compared instead of the part with itself");
    const std::optional<units::Units::Length>& against_unit = t.length_unit("--against-units", "Unit of REF");
    const std::string& transform_in = t.optional_file(
        "--transform-in", "FILE", "4 x 4 matrix that puts PART onto REF, as fettle-align writes it: do not register");
    const std::string& transform_out =
        t.optional_output("--transform-out", "Write the 4 x 4 matrix that was applied, 17 digits");
    const double& probability = t.number("--probability", find::FindOptions().min_probability, "SHARE",
                                         "Leave out what is less probable", core::Range{0, 1, true, true});
    const std::optional<double>& width = t.optional_number(
        "--max-width", "LENGTH", "Width of the widest anomaly; default: 45 mm", core::Range::positive());
    const std::optional<double>& height = t.optional_number(
        "--min-height", "LENGTH", "Leave out what is lower; default: 0.2 mm", core::Range::at_least(0));
    const std::string& keep =
        t.text("--keep", "", "ROW,…", "These rows are anomalies: takes the doubt away that the run without it reports");
    const std::string& drop = t.text("--drop", "", "ROW,…", "These rows belong to the part: leaves them out");
    const std::string& format =
        t.choice("--format", "", {"pcd", "ply", "csv", "vtk", "stl"},
                 "Format of the output; default: by the suffix of -o, else PCD, or STL for a mesh");
    const bool& ascii = t.flag("--ascii", "Write PCD as text");
};

find::FindOptions find_options(const Options& o, double mm)
{
    find::FindOptions options;
    options.min_probability = o.probability;
    if (o.width) options.bounds = find::bounds_for_width(*o.width * mm);
    if (o.height) options.bounds.min_height = *o.height * mm;
    return options;
}

find::FindResult find_against(const Options& o, const mesh::CloudMeshFile& part, const std::string& name)
{
    const std::string reference_name = core::display_name(o.against);
    const mesh::ShapeFile reference = mesh::read_shape(o.against, mesh::resolve_file_units(o.against_unit));
    for (const std::string& warning : job::shape_warnings(reference, reference_name, reference.units))
        o.t.warn(warning);
    const double mm = part.units.mm();
    std::optional<Eigen::Isometry3d> stated;
    if (!o.transform_in.empty()) {
        stated = Eigen::Isometry3d(align::read_transform(o.transform_in));
        stated->translation() *= mm;
    }
    const find::Registration registration =
        cli::with_error_prefix(name, [&] { return find::register_part(part.part, reference.shape, stated); });
    if (!registration.converged) throw core::InputError(name, "cannot be registered to " + reference_name);
    for (const std::string& doubt : registration.doubts) o.t.warn(name + ": " + doubt);
    if (!o.transform_out.empty()) {
        Eigen::Matrix4d matrix = registration.T_reference_part.matrix();
        matrix.topRightCorner<3, 1>() /= mm;
        align::write_transform(o.t.output_file(o.transform_out), matrix);
    }
    const find::SignedDistances distances =
        find::signed_distances(part.part, reference.shape, registration.T_reference_part);
    return cli::with_error_prefix(
        name, [&] { return find::find_anomalies_against(part.part, distances, find_options(o, mm)); });
}

const std::string kDescription =
    "Finds anomalies of a part: excess material that stands over the surface around it.\n"
    "Out: the part with all its fields and triangles, and the fields anomaly (0 none, else the row of the report) and "
    "height over the surface beneath. Without --against the part itself says what belongs to it: smooth metal around a "
    "region is continued beneath it, and the region judged by how far and how plainly it stands over that. The report "
    "has a row for each anomaly: probability, height, area, volume, significance (height in standard deviations of the "
    "surface beneath), and a doubt where a person should look. Exit 1 if anomalies were found.";

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-part parts/hammer.json | fettle-find --report found.json -o labelled.pcd || true",
                  "the weld bead on the hammer: which points it has, and how high it stands over them");
        t.reference("ISO 16610-71 (robust regression filter); Sternberg 1986 (opening by a ball); Rousseeuw 1984; "
                    "Platt 1999 (probabilities)");
        t.parse();
        if (o.against.empty() && (!o.transform_in.empty() || !o.transform_out.empty() || o.against_unit))
            throw core::InputError("--against", "is needed by --transform-in, --transform-out and --against-units");
        const std::vector<int> keep = parse_rows("--keep", o.keep), drop = parse_rows("--drop", o.drop);

        mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.path, mesh::resolve_file_units(o.unit));
        const std::string name = core::display_name(o.path);
        mesh::PartFormat format = mesh::part_format(t.output_name(), o.format, file.part.is_mesh());
        if (o.ascii && format != mesh::PartFormat::pcd) throw core::InputError("--ascii", "goes with PCD");
        if (o.ascii) format = mesh::PartFormat::pcd_ascii;
        for (const std::string& warning : job::shape_warnings(file, name)) t.warn(warning);

        find::FindResult result =
            o.against.empty()
                ? cli::with_error_prefix(
                      name, [&] { return find::find_anomalies(file.part, find_options(o, file.units.mm())); })
                : find_against(o, file, name);
        find::judge(result, keep, drop);
        find::set_report(t.report(), result, file.units);
        for (const find::FoundAnomaly& anomaly : result.anomalies)
            if (!anomaly.doubt.empty()) t.note(std::to_string(anomaly.number) + ": " + anomaly.doubt);
        mesh::write_cloud_mesh(t.output(), find::labelled(std::move(file.part), result), format, file.units);
        return result.anomalies.empty() ? cli::Verdict::yes : cli::Verdict::no;
    });
}
