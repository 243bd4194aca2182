#include "belt/contact_path.h"
#include "belt/path_filter.h"
#include "belt/path_links.h"
#include "belt/path_report.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "cloud/poses.h"
#include "core/file.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

#include <optional>

using namespace fettle;

namespace {

const std::string kDescription =
    "Plan contact paths over a patch of surfels, or make a path denser.\n"
    "From surfels: rows or a spiral over each patch; points with position and quaternion (+z the outward normal), "
    "pass and stroke. From a path: points inserted where the distance of two exceeds --spacing, positions by "
    "lerp, orientations by slerp along the shorter arc. With --clearance the strokes are joined off the part: "
    "along the tool's axis away from it, from stroke to stroke over the part's convex hull, grown by the "
    "clearance, and along the axis back; a tool no part of which lies below its tip stays that far off. stroke is "
    "then -1 between strokes, and motion says how the tool comes to a point: 0 on the part, 1 near it along the "
    "axis, 2 farther off along it, 3 from stroke to stroke. With --held part the field way is the contact's way "
    "along the part, which fettle-arm's --feed is along. Lengths in mm. Exit 1 if the path has no point.";

constexpr double kMinSpacing = 1e-3; // mm: below what any machine resolves; keeps the number of points bounded

struct Options {
    cli::Tool& t;
    const belt::ContactPathOptions defaults = {};
    const std::string& points = t.main_input("POINTS", "Surfels, or a path (fields qw qx qy qz), PCD");
    const std::optional<double>& spacing =
        t.optional_number("--spacing", "MM", "Maximum distance of points [surfels: 1; a path: as it is]",
                          core::Range::at_least(kMinSpacing));
    const belt::PathPattern& pattern = t.choice<belt::PathPattern>(
        "--pattern", {{"rows", belt::PathPattern::rows}, {"spiral", belt::PathPattern::spiral}},
        "Pattern over surfels; a spiral runs along the sides of the patch, inwards");
    const int& patch =
        t.count("--patch", -1, "Patch whose surfels are taken; -1: all, one after the other", -1, 1 << 30);
    const double& step_over = t.number("--step-over", defaults.step_over, "MM",
                                       "Maximum distance of rows, or of turns of the spiral", core::Range::positive());
    const bool& along_v =
        t.choice<bool>("--along", {{"u", false}, {"v", true}}, "Direction of rows, and of a spiral's first side");
    const bool& one_way = t.flag("--one-way", "All rows run the same way, not there and back");
    const std::string& orientation =
        t.choice("--orientation", "auto", {"auto", "fixed", "along"},
                 "The tool's x. fixed: on every row to the same side, so that a path there and back does not turn the "
                 "tool; along: along the feed; auto: fixed on rows, along a spiral");
    const std::optional<double>& above = t.optional_number(
        "--above", "MM", "Only points less than a --step-over from stock that stands higher over the design", {});
    const std::string& room_for = t.optional_file(
        "--room-for", "FILE", "Only points where the wheel of this file (JSON), less its layer, is not in the design");
    const std::string& no_room_for = t.optional_file(
        "--no-room-for", "FILE", "Only points where the wheel of this file is in the design: for a smaller one");
    const std::optional<double>& clearance = t.optional_number(
        "--clearance", "MM", "Join the strokes, on the way at least so far off the part", core::Range::positive());
    const std::optional<double>& approach =
        t.optional_number("--approach", "MM", "Joined strokes: height over the part where the approach begins [5]",
                          core::Range::positive());
    const std::string& part =
        t.optional_file("--part", "FILE", "The part of which to stay clear, mesh or points [surfels: all of them]");
    const std::optional<units::Units::Length>& part_unit = t.length_unit("--part-units", "Unit of that file [mm]");
    const bool& on_stock = t.flag("--on-stock", "Positions on the stock, not on the design");
    const std::string& held =
        t.choice("--held", "tool", {"tool", "part"},
                 "What the robot holds. part: the output is the poses of the part in the cell that bring each contact "
                 "point to --wheel; the part's frame is the tool frame of the robot's file");
    const std::string& wheel =
        t.text("--wheel", "", "X,Y,Z,QW,QX,QY,QZ", "The contact frame of the fixed wheel: +z into it, +x the feed");
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
              "--stock-units in --spacing 1 | fettle-path --step-over 10 --spacing 2 > rows.pcd",
              "rows over a saddle");
    t.reference("Ren et al. 2006, eq. 6; Shoemake 1985 (slerp)");
}

belt::ContactPathOptions path_options(const Options& o)
{
    belt::ContactPathOptions options = {o.patch, o.pattern, o.along_v, o.one_way};
    const bool is_fixed = o.orientation == "auto" ? o.pattern == belt::PathPattern::rows : o.orientation == "fixed";
    options.orientation = is_fixed ? belt::PathOrientation::fixed : belt::PathOrientation::along;
    options.on_stock = o.on_stock;
    options.step_over = o.step_over;
    options.spacing = o.spacing.value_or(o.defaults.spacing);
    return options;
}

/// The points that --above, --room-for and --no-room-for leave.
belt::ContactPath select_points(const Options& o, const belt::Surfels& surfels, belt::ContactPath path)
{
    if (o.above) path = belt::select_points(path, belt::select_high_stock(surfels, path, o.step_over, *o.above));
    for (const bool has_room : {true, false}) {
        const std::string& wheel = has_room ? o.room_for : o.no_room_for;
        if (wheel.empty()) continue;
        belt::PathSelection selection = belt::select_by_room(surfels, path, belt::read_contact_wheel(wheel));
        if (!has_room) selection.flip();
        path = belt::select_points(path, selection);
    }
    return path;
}

/// The contact path over surfels, or the given path with points inserted, its strokes joined if that is asked for.
cloud::Cloud make_path(const Options& o, cloud::Cloud cloud, const std::string& source)
try {
    belt::LinkOptions links;
    Eigen::Matrix3Xd part;
    if (!o.part.empty()) {
        const mesh::ShapeFile file = mesh::read_shape(o.part, mesh::resolve_file_units(o.part_unit));
        for (const std::string& doubt : job::shape_warnings(file, core::display_name(o.part), file.units))
            o.t.warn(doubt);
        part = mesh::coordinates_of(file.shape);
    }
    if (!cloud::has_poses(cloud)) {
        const belt::Surfels surfels = belt::surfels_from_cloud(cloud, source);
        belt::ContactPath path = belt::contact_path(surfels, path_options(o));
        path = select_points(o, surfels, std::move(path));
        for (const int patch : path.skipped_patches)
            o.t.warn(source + ": too few surfels on patch " + std::to_string(patch) + ": no path there");
        cloud = belt::to_cloud(path);
        if (o.part.empty()) {
            part = belt::outer_positions(surfels);
            links.uncertainty += surfels.radius.size() > 0 ? surfels.radius.maxCoeff() : 0;
        }
    } else if (o.above || !o.room_for.empty() || !o.no_room_for.empty()) {
        throw core::InputError("--above, --room-for and --no-room-for go with surfels");
    } else if (o.spacing) {
        cloud = belt::interpolate_path(cloud, *o.spacing);
    }
    if (!o.clearance) return cloud;
    if (part.cols() == 0) throw core::InputError("--clearance: over a path it needs the --part to be clear of");
    links.clearance = *o.clearance;
    links.approach = o.approach.value_or(links.approach);
    return belt::link_strokes(cloud, part, links);
} catch (const core::InputError& error) {
    const std::string text = error.what();
    if (text.starts_with(source) || text.starts_with("--") || (!o.part.empty() && text.starts_with(o.part))) throw;
    throw core::InputError(source, text);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        if ((o.held == "part") != !o.wheel.empty()) throw core::InputError("--held part and --wheel go together");
        if ((o.approach || !o.part.empty()) && !o.clearance)
            throw core::InputError("--approach and --part go with --clearance");

        cloud::Cloud path = make_path(o, cloud::read_cloud(o.points).cloud, core::display_name(o.points));
        t.report() = belt::report_path(path);
        if (o.held == "part") {
            const Eigen::Isometry3d T_cell_wheel =
                cli::with_error_prefix("--wheel", [&] { return cloud::parse_pose(o.wheel); });
            const cloud::PosePath T_part_contact = cloud::read_poses(path);
            cloud::set_field(path, "way", belt::way_along(T_part_contact), 8);
            cloud::set_poses(path, belt::held_part_path(T_part_contact, T_cell_wheel));
            path.comment = "frame: cell";
        }
        o.out.write(path, units::Units{});
        return path.size() > 0 ? cli::Verdict::yes : cli::Verdict::no;
    });
}
