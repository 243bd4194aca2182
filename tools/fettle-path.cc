#include "belt/contact_path.h"
#include "belt/path_report.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "cloud/poses.h"
#include "core/file.h"

#include <optional>

using namespace fettle;

namespace {

const std::string kDescription =
    "Contact paths over a patch of surfels, and paths made denser.\n"
    "From surfels: rows or a spiral; points with position and quaternion (+z the outward normal, +x along the feed) "
    "and pass. From a path: points inserted where the distance of two exceeds --spacing, positions by lerp, "
    "orientations by slerp along the shorter arc. Lengths in mm. Exit 1 if the path has no point.";

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
    const int& patch = t.count("--patch", 0, "Patch whose surfels are taken", 0, 1 << 30);
    const double& step_over = t.number("--step-over", defaults.step_over, "MM",
                                       "Maximum distance of rows, or of turns of the spiral", core::Range::positive());
    const bool& along_v =
        t.choice<bool>("--along", {{"u", false}, {"v", true}}, "Direction of rows, and of a spiral's first side");
    const bool& one_way = t.flag("--one-way", "All rows run the same way, not there and back");
    const bool& on_stock = t.flag("--on-stock", "Positions on the stock, not on the design");
    const std::string& held =
        t.choice("--held", "tool", {"tool", "part"},
                 "What the robot holds. part: the output is the poses of the part in the cell that bring each contact "
                 "point to --wheel; the part's frame is the tool frame of the robot's file");
    const std::string& wheel =
        t.text("--wheel", "", "X,Y,Z,QW,QX,QY,QZ", "The contact frame of the fixed wheel: +z into it, +x the feed");
    const bool& ascii = t.flag("--ascii", "Text instead of binary");
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
              "--stock-units in --spacing 1 | fettle-path --step-over 10 --spacing 2 > rows.pcd",
              "rows over a saddle");
    t.reference("Ren et al. 2006, eq. 6; Shoemake 1985 (slerp)");
}

/// The contact path over surfels, or the given path with points inserted; its report.
cloud::Cloud make_path(const Options& o, cloud::Cloud cloud, const std::string& source)
try {
    if (!cloud::has_poses(cloud)) {
        const belt::ContactPathOptions options = {
            o.patch, o.pattern, o.along_v, o.one_way, o.on_stock, o.step_over, o.spacing.value_or(o.defaults.spacing)};
        cloud = belt::to_cloud(belt::contact_path(belt::surfels_from_cloud(cloud, source), options));
    } else if (o.spacing) {
        cloud = belt::interpolate_path(cloud, *o.spacing);
    }
    o.t.report() = belt::report_path(cloud);
    return cloud;
} catch (const core::InputError& error) {
    if (std::string(error.what()).starts_with(source)) throw;
    throw core::InputError(source, error.what());
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        if ((o.held == "part") != !o.wheel.empty()) throw core::InputError("--held part and --wheel go together");

        cloud::Cloud path = make_path(o, cloud::read_cloud(o.points).cloud, core::display_name(o.points));
        if (o.held == "part") {
            const Eigen::Isometry3d T_cell_wheel =
                cli::with_error_prefix("--wheel", [&] { return cloud::parse_pose(o.wheel); });
            cloud::set_poses(path, belt::held_part_path(cloud::read_poses(path), T_cell_wheel));
            path.comment = "frame: cell";
        }
        cloud::write_pcd(t.output(), path, units::Units{}, cloud::pcd_encoding(o.ascii));
        return path.size() > 0 ? cli::Verdict::yes : cli::Verdict::no;
    });
}
