#include "belt/contact_path.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/solve_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

using namespace fettle;

namespace {

Eigen::Isometry3d pose_in(const std::string& text, const std::string& option)
{
    const Eigen::VectorXd numbers = numbers_in(text);
    if (numbers.size() != 7 || !numbers.allFinite() || !(numbers.tail<4>().norm() > 0))
        throw InputError(option, "expected x,y,z,qw,qx,qy,qz, got " + in_quotes(text));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = numbers.head<3>();
    pose.linear() = Eigen::Quaterniond(numbers[3], numbers[4], numbers[5], numbers[6]).normalized().toRotationMatrix();
    return pose;
}

Cloud to_cloud(const ContactPath& path)
{
    Cloud cloud;
    const auto size = static_cast<Eigen::Index>(path.poses.size());
    cloud.xyz.resize(3, size);
    cloud.comment = "frame: part";
    set_path(cloud, path.poses);
    set_field(cloud, "pass", Eigen::Map<const Eigen::VectorXi>(path.pass.data(), size).cast<double>());
    return cloud;
}

/// Lengths and turns between points of one pass.
void add_report(json::Value& report, const Cloud& path)
{
    const PosePath poses = path_poses(path);
    const Eigen::VectorXd pass =
        has_field(path, "pass") ? field(path, "pass") : Eigen::VectorXd(Eigen::VectorXd::Zero(path.size()));
    double length = 0, longest = 0, turn = 0;
    std::size_t passes = poses.empty() ? 0 : 1;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        if (pass[static_cast<Eigen::Index>(i)] != pass[static_cast<Eigen::Index>(i) - 1]) {
            ++passes;
            continue;
        }
        const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
        if (!std::isfinite(step)) continue;
        length += step;
        longest = std::max(longest, step);
        turn = std::max(
            turn, Eigen::Quaterniond(poses[i].linear()).angularDistance(Eigen::Quaterniond(poses[i - 1].linear())));
    }
    report.set("points", poses.size()).set("passes", passes).set("length", length).set("longest_step", longest);
    report.set("largest_turn_deg", turn * 180 / std::numbers::pi);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Contact paths over a patch of surfels, and paths made denser.\n"
        "From surfels: rows or a spiral; points with position and quaternion (+z the outward normal, +x along the "
        "feed) and pass. From a path: points inserted between those farther apart than --spacing, positions by lerp, "
        "orientations by slerp along the shorter arc. Lengths in mm. Exit 1 if the path has no point.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path = t.input("POINTS", "Surfels, or a path (fields qw qx qy qz), PCD");
        const auto& spacing = t.number_if_given(
            "--spacing", "MM", "Points are no farther apart [surfels: 1; a path: as it is]", Range::positive());
        const std::string& pattern = t.choice("--pattern", "rows", {"rows", "spiral"},
                                              "Over surfels; a spiral runs along the sides of the patch, inwards");
        ContactPathOptions options;
        const int& patch = t.count("--patch", 0, "Of the surfels", 0, 1 << 30);
        const double& step_over = t.number("--step-over", options.step_over, "MM",
                                           "Rows or turns of the spiral are no farther apart", Range::positive());
        const std::string& along = t.choice("--along", "u", {"u", "v"}, "Rows, and a spiral's first side, run along");
        const bool& one_way = t.flag("--one-way", "All rows run the same way, not there and back");
        const bool& on_stock = t.flag("--on-stock", "Positions on the stock, not on the design");
        const std::string& held =
            t.choice("--held", "tool", {"tool", "part"},
                     "What the robot holds. part: out come poses of the part in the cell that bring each contact "
                     "point to --wheel; the part's frame is the tool frame of the robot's file");
        const std::string& wheel =
            t.text("--wheel", "", "X,Y,Z,QW,QX,QY,QZ", "The contact frame of the fixed wheel: +z into it, +x the feed");
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
                  "--stock-units in --spacing 1 | fettle-path --step-over 10 --spacing 2 > rows.pcd",
                  "rows over a saddle");
        t.reference("Ren et al. 2006, eq. 6; Shoemake 1985 (slerp)");
        t.parse();

        if ((held == "part") != !wheel.empty()) throw InputError("--held part and --wheel go together");
        Cloud cloud = read_cloud(path, Units{}).cloud;
        const std::string source = display_name(path);
        try {
            if (!has_poses(cloud)) {
                options.patch = patch;
                options.pattern = pattern == "rows" ? PathPattern::rows : PathPattern::spiral;
                options.along_v = along == "v";
                options.one_way = one_way;
                options.on_stock = on_stock;
                options.step_over = step_over;
                options.spacing = spacing.value_or(options.spacing);
                cloud = to_cloud(contact_path(surfels_of(cloud, source), options));
            } else if (spacing) {
                cloud = interpolated(cloud, *spacing);
            }
            add_report(t.report(), cloud);
        } catch (const InputError& error) {
            if (std::string(error.what()).starts_with(source)) throw;
            throw InputError(source, error.what());
        }
        if (held == "part") {
            set_path(cloud, held_part(path_poses(cloud), pose_in(wheel, "--wheel")));
            cloud.comment = "frame: cell";
        }
        write_pcd(t.output(), cloud, Units{}, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return cloud.size() > 0 ? Verdict::yes : Verdict::no;
    });
}
