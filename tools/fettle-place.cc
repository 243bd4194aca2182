#include "align/rigid.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "core/constants.h"
#include "core/file.h"
#include "job/picked.h"
#include "job/shape_warnings.h"
#include "mesh/part_output.h"
#include "mesh/read_formats.h"
#include "mesh/shape_file.h"
#include "place/place.h"

using namespace fettle;

namespace {

std::vector<place::Turn> parse_turns(const std::string& text)
{
    const std::vector<std::string> words = cli::split_list(text);
    if (words.size() % 2 != 0) throw core::InputError("expected AXIS,DEG,..., got '" + text + "'");
    std::vector<place::Turn> turns;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        const std::string& axis = cli::check_choice({"x", "y", "z"}, words[i]);
        turns.push_back({axis[0] - 'x', core::kRadPerDegree * cli::parse_number_in(words[i + 1], {})});
    }
    return turns;
}

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("IN", mesh::kReadFormats);
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of IN, if it states none; default: mm, or the unit of the job of --into");
    const std::string& matrix = t.optional_file(
        "--matrix", "FILE", "Move by this 4 x 4 matrix, as fettle-align writes it: lengths in the unit of IN");
    const std::string& turns =
        t.text("--turn", "", "AXIS,DEG,...", "Turn about x, y or z, counter-clockwise, one turn after the other");
    const std::string& up =
        t.text("--up", "", "plane|cylinder|PICKED",
               "Turn so that this faces up, +z: the largest plane or cylinder of the part, or the plane through points "
               "picked in CloudCompare or pcd_viewer (a file)");
    const std::optional<double>& threshold = t.optional_number(
        "--threshold", "LENGTH",
        "Points no farther from the plane or cylinder belong to it; default: 1/500 of the part's diagonal",
        core::Range::positive());
    const std::string& into = t.optional_file(
        "--into", "JOB", "Move into the frame of this job, in which its anomaly faces up; not with the others");
    const bool& centre =
        t.flag("--centre", "Put the centre of what faces up, or of the part's bounding box, to the origin");
    const std::string& transform_out =
        t.optional_output("--transform-out", "Write the 4 x 4 matrix that was applied, 17 digits", {});
    const std::string& inverse = t.optional_output("--inverse", "Write the matrix that moves the part back", {});
    const mesh::PartOutput out{t};
};

place::PlaceRequest parse_request(const Options& o)
{
    place::PlaceRequest request;
    if (!o.matrix.empty()) request.matrix = align::read_transform(o.matrix);
    request.turns = cli::with_error_prefix("--turn", [&] { return parse_turns(o.turns); });
    if (o.up == "plane") request.up = place::RegionShape::plane;
    if (o.up == "cylinder") request.up = place::RegionShape::cylinder;
    if (!o.up.empty() && !request.up) request.picked = job::read_picked_points(o.up);
    if (o.threshold && !request.up) throw core::InputError("--threshold", "goes with --up plane or --up cylinder");
    request.is_centred = o.centre;
    if (!o.into.empty()) {
        if (request.matrix || !request.turns.empty() || !o.up.empty() || o.centre)
            throw core::InputError("--into", "goes without --matrix, --turn, --up and --centre");
        request.into = job::read_job(o.into);
    }
    return request;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Move a part: by a matrix, by turns, or so that a face of it is up; convert its unit.\n"
        "Out: the cloud or mesh with all its triangles and fields; normals, poses and viewpoint are turned with it. "
        "The matrix is applied first, then the turns, then --up, then --centre. A face's upper side is where the "
        "normals of mesh or cloud point; of a cloud without normals, the side of its viewpoint, and where it states "
        "none, "
        "the convex side, which is said.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-place scans/hammer.stl --up plane --centre --inverse back.txt -o lying.stl",
                  "the hammer with its largest flat face up, and the matrix that moves it back");
        t.example("fettle-place scans/hammer.stl --into jobs/hammer.json --inverse back.txt -o there.stl",
                  "the part as the job sees it; --matrix back.txt moves back what was ground");
        t.reference("Fischler & Bolles 1981 (RANSAC); PCL's SACSegmentationFromNormals");
        t.parse();
        place::PlaceRequest request = parse_request(o);

        mesh::CloudMeshFile file = mesh::read_cloud_mesh(
            o.path, mesh::resolve_file_units(o.unit, request.into ? std::optional(request.into->units) : std::nullopt));
        const std::string name = core::display_name(o.path);
        const auto is_joint = [](const cloud::Field& field) { return field.name.starts_with("joint"); };
        if (std::erase_if(file.part.points.fields, is_joint) > 0)
            t.warn(name + ": its joints reach where it was, and are left out");
        o.out.format_for(file.part.is_mesh());
        const double mm = file.units.mm();
        if (request.picked) *request.picked *= mm;
        if (request.threshold = o.threshold; request.threshold) *request.threshold *= mm;
        for (const std::string& warning : job::shape_warnings(file, name)) t.warn(warning);

        const place::PlacedPart placed =
            cli::with_error_prefix(name, [&] { return place::place_part(std::move(file.part), request, mm); });
        if (!o.transform_out.empty()) align::write_transform(t.output_file(o.transform_out), placed.transform);
        if (!o.inverse.empty()) align::write_transform(t.output_file(o.inverse), place::inverse_of(placed.transform));
        t.report().set("transform", Eigen::MatrixXd(placed.transform));
        if (placed.is_side_guessed)
            t.warn(name + ": has neither normals nor a viewpoint: which side is up is a guess, and --turn x,180 turns "
                          "the result over");
        if (placed.region) {
            t.report().set("up", Eigen::VectorXd(placed.region->up));
            if (placed.region->radius > 0) t.report().set("radius", placed.region->radius / mm);
            if (placed.region->share > 0) t.report().set("share", placed.region->share);
        }
        o.out.write(placed.part, file.units);
        return cli::Verdict::yes;
    });
}
