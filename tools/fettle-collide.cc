#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/direction.h"
#include "core/file.h"
#include "job/shape_warnings.h"
#include "mesh/mesh_file.h"
#include "mesh/shape_file.h"
#include "robot/cell_picture.h"
#include "robot/collision_report.h"
#include "robot/collision_study.h"
#include "robot/path_cloud.h"
#include "robot/path_options.h"
#include "robot/path_stamp.h"

#include <optional>

using namespace fettle;

namespace {

const std::string kDescription =
    "Find the collisions of a robot along a path: arm, tool, fixtures and workpiece, at the poses and between them.\n"
    "Signed clearances of the solids of the robot file among each other and against every triangle of the workpiece: "
    "negative is the penetration depth, the shortest translation that separates two solids, or how deep the workpiece "
    "lies in one. Bodies on one link or on neighbouring links and allowed pairs are left out. A contact no deeper than "
    "the tolerance is no collision. PATH holds poses (as for fettle-arm --inverse, whose joints are found here) or "
    "joints.\n"
    "Added: clearance of the pose, clearance_between (on the motion from the pose before, a lower bound), body "
    "and other (which bodies: indices in the robot file from 0, the workpiece after the last), foot_x foot_y foot_z "
    "(where, in the cell). Exit 1 if something collides, a pose is not reached or the path jumps.\n"
    "A path that is clear of a --workpiece is stamped in its header, checked DIGEST clearance D between D strokes D "
    "part DIGITS (minimum at poses, between them, and on the way from stroke to stroke): fettle-arm writes programs of "
    "such paths only.\n"
    "With --avoid such poses are tilted about the centre of the ball at the tip, so that the point of contact stays "
    "(about the tip if there is no ball), on cones 5 degrees apart up to --max-tilt; the first tilt that is free of "
    "collisions and reached without a jump is taken. Where that does not help, the tool retreats by steps of 0.1 mm, "
    "along the normal if the path has normals, else along its axis. smooth optimises the tilts of all poses together, "
    "so that they change as little as possible from pose to pose. Track and table stay.\n"
    "--avoid adds: avoided, tilt, "
    "tilt_towards, retreat; then all else is about the changed path.";

struct Options {
    cli::Tool& t;
    robot::RobotOptions robot{t};
    const std::string& points = t.main_input("PATH", "path or joints, PCD");
    const std::string& part = t.optional_file("--workpiece", "MESH", "STL, PLY, OBJ, OFF, in the part's frame [none]");
    const bool& held = t.flag("--held", "The robot holds the workpiece; PATH is of fettle-path --held part");
    const std::optional<units::Units::Length>& part_unit =
        t.length_unit("--workpiece-units", "Unit of that file, if it is not the path's");
    const std::optional<units::Units::Length>& unit =
        t.length_unit("--file-units", "Unit of PATH, and of lengths here [its header, or mm]");
    const std::optional<double>& tolerance =
        t.optional_number("--tolerance", "LENGTH", "An overlap no deeper is a contact, not a collision [0.01 mm]",
                          core::Range::at_least(0));
    const std::optional<double>& max_clearance = t.optional_number(
        "--beyond", "LENGTH", "Larger clearances are reported as this one [50 mm]", core::Range::positive());
    const std::optional<double>& resolution =
        t.optional_number("--resolution", "LENGTH",
                          "Between poses: maximum relative motion of two near bodies from check to check [0.1 mm]",
                          core::Range::positive());
    robot::PathOptions path{t};
    const std::string& avoid = t.optional_choice(
        "--avoid", {"pose", "smooth"}, "Change the path to avoid collisions, pose by pose or smoothly [pose]");
    const double& max_tilt =
        t.number("--max-tilt", 45, "DEG", "With --avoid: maximum tilt of the tool", core::Range::between(0, 90));
    const std::optional<double>& max_retreat = t.optional_number(
        "--max-retreat", "LENGTH", "With --avoid: maximum retreat of the tool [1 mm]", core::Range::at_least(0));
    const std::string& method =
        t.choice("--method", "exact", {"exact", "grid", "paper"},
                 "Workpiece as all triangles; as those under the tool, elsewhere cuboids over a grid; or the same by "
                 "the formulas that Chen & Wei print");
    const bool& exact = t.flag("--exact", "All triangles, everywhere: --method exact");
    const std::optional<double>& cell =
        t.optional_number("--cell", "LENGTH", "Side of a grid cell [1 mm]", core::Range::positive());
    const std::string& picture = t.optional_output(
        "--picture", "Draw the cell at some poses, PNG; the workpiece as --method represents it", {"png"});
    const std::string& at =
        t.text("--at", "", "N,...", "Indices of these poses, from 0 [that with the minimum clearance]");
    const std::string& from =
        t.text("--from", "1,-1,0.8", "X,Y,Z", "Direction from the cell to the eye, for the picture");
    const std::string& chart = t.optional_output("--chart", "Draw the clearances along the path, PNG", {"png"});
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-part parts/keel.json | fettle-collide robots/irb1400.json paths/keel.pcd --workpiece - "
              "--report clear.json > checked.pcd",
              "does the robot touch anything but the keel along which its ball runs?");
    t.reference("Chen & Wei, 4, 5 and algorithm 1; Gilbert, Johnson & Keerthi 1988; van den Bergen 2001");
}

robot::CollisionRequest request(const Options& o, double mm)
{
    if (o.exact && o.method != "exact") throw core::InputError("--exact: and --method " + o.method + ": one of them");
    if (o.held && (o.part.empty() || !o.avoid.empty() || o.method != "exact"))
        throw core::InputError("--held", "goes with --workpiece, and neither with --avoid nor with --method");
    robot::CollisionRequest r;
    r.path = o.path.arguments();
    if (o.tolerance) r.collision.tolerance = *o.tolerance * mm;
    if (o.max_clearance) r.collision.max_clearance = *o.max_clearance * mm;
    if (o.resolution) r.collision.resolution = *o.resolution * mm;
    if (!o.avoid.empty())
        r.avoid = {o.avoid == "smooth", o.max_tilt * core::kRadPerDegree, o.max_retreat.value_or(1 / mm) * mm,
                   o.path.jump * core::kRadPerDegree};
    const robot::Formulas formulas = o.method == "paper" ? robot::Formulas::published : robot::Formulas::corrected;
    if (o.method != "exact") r.model = {o.cell.value_or(1 / mm) * mm, formulas, r.collision.tolerance};
    return r;
}

void draw(const Options& o, const robot::Robot& robot, const mesh::Mesh* workpiece, const robot::CollisionStudy& study,
          const units::Units& units)
{
    if (!o.picture.empty()) {
        const robot::CellPictureOptions options = {robot::parse_pose_indices(o.at, study.checked),
                                                   core::parse_direction(o.from, "--from"),
                                                   study.request.collision.tolerance, units, study.model.get()};
        o.t.output_file(o.picture) << robot::draw_cell_picture(robot, workpiece, study.solved.path.joints,
                                                               study.checked, options);
    }
    if (!o.chart.empty())
        o.t.output_file(o.chart) << robot::draw_clearance_chart(study.checked, study.avoided ? &study.before : nullptr,
                                                                study.avoided ? &study.avoided->changes : nullptr,
                                                                study.request.collision.tolerance, units);
}

/// Stamps a path that the robot can run without a collision, or says why it does not.
void stamp(cli::Tool& t, const robot::Robot& robot, const robot::CollisionStudy& study, const mesh::Mesh* workpiece,
           const std::optional<double>& strokes, double mm, cloud::Cloud& path)
{
    const std::string obstacle = robot::stamp_obstacle(robot, study, workpiece != nullptr);
    t.report().set("stamped", obstacle.empty());
    if (obstacle.empty())
        path.comment = robot::stamp_text(robot, path, study.checked, strokes, *workpiece, mm);
    else
        t.note("the path is not stamped as checked, so that it becomes no program: " + obstacle);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();

        robot::Robot robot = o.robot.read();
        robot.holds_workpiece = o.held;
        if (robot.bodies.empty()) t.warn(core::display_name(o.robot.file) + ": has no bodies: nothing can collide");
        if (o.held && robot.table) throw core::InputError("--held", "a robot with a table does not hold the workpiece");
        auto [path, units] = cloud::read_cloud(o.points, mesh::resolve_file_units(o.unit));
        if (!o.part.empty() && !o.held && cloud::has_field(path, "way"))
            throw core::InputError(core::display_name(o.points),
                                   "is of a part in the robot's hand (field way): --held checks it there");
        const robot::CollisionRequest wanted = request(o, units.mm());
        std::optional<mesh::Mesh> mesh;
        std::optional<robot::Workpiece> workpiece;
        if (!o.part.empty()) {
            const units::Units unit{o.part_unit.value_or(units.length)};
            mesh::MeshRepair repair;
            workpiece.emplace(mesh.emplace(mesh::read_mesh(o.part, unit.length, &repair)));
            for (const std::string& doubt : job::shape_warnings(*mesh, repair, core::display_name(o.part), unit))
                t.warn(doubt);
            if (!workpiece->closed())
                t.warn(core::display_name(o.part) + ": is not closed: a body wholly inside it would not be noticed");
        }
        const robot::CollisionStudy study =
            robot::study_collisions(robot, path, core::display_name(o.points), units.mm(),
                                    workpiece ? &*workpiece : nullptr, wanted, t.progress("poses"));

        draw(o, robot, mesh ? &*mesh : nullptr, study, units);
        robot::set_fields(path, robot, study);
        const bool clear = robot::add_report(t.report(), robot, study, robot::pose_times(path), units);
        const std::optional<double> strokes =
            robot::min_travel_clearance(robot, workpiece ? &*workpiece : nullptr, path, study);
        if (strokes) t.report().set("min_between_strokes", *strokes / units.mm());
        path.comment.clear();
        if (clear) stamp(t, robot, study, mesh ? &*mesh : nullptr, strokes, units.mm(), path);
        o.out.write(path, units);
        return clear ? cli::Verdict::yes : cli::Verdict::no;
    });
}
