// A UR5 with a ball-end tool along 50,000 poses over a boat's hull of 100,000 triangles, its links as the triangles of
// their collision meshes, as the convex hulls of these, and as boxes around them; and the IRB 1400 on the path
// of cell_bench, its links and fixtures as the round solids that they are and as 15,000 triangles each. All pairs at
// the poses, and between them. One core.

#include "../lib/boat_hull.h"
#include "robot/cell_scene.h"
#include "robot/collision.h"
#include "robot/follow.h"
#include "robot/hull_points.h"
#include "robot/mesh_body.h"
#include "robot/urdf.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <numbers>

using namespace fettle;

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr int kPoses = 50000, kTriangles = 100000;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

mesh::Mesh hull_at(const Vector3d& place)
{
    mesh::Mesh mesh = boat::hull(kTriangles);
    mesh.vertices.colwise() += place;
    return mesh;
}

cloud::PosePath path_at(const Vector3d& place, double turn)
{
    cloud::PosePath poses = boat::poses(kPoses);
    for (Isometry3d& T : poses) {
        T = Eigen::Translation3d(place) * T * Eigen::Translation3d(0, 0, -boat::kBall);
        T.linear() = T.linear() * Eigen::AngleAxisd(turn, Vector3d::UnitZ());
    }
    return poses;
}

robot::Robot ur5_with_tool()
{
    robot::UrdfOptions options;
    options.srdf = "samples/robots/ur5/ur5.srdf";
    robot::Robot robot = robot::read_robot("samples/robots/ur5/ur5.urdf", options);
    constexpr double kToolLength = 180; // mm
    robot.T_flange_tool.translate(Vector3d(0, 0, -kToolLength));
    const auto add = [&](const char* name, const robot::Solid& solid) {
        robot.bodies.push_back({name, robot::link::kTool, solid});
    };
    const auto on_axis = [](double z) { return Vector3d(0, 0, z); };
    add("ball", robot::solid::Sphere{on_axis(boat::kBall), boat::kBall});
    add("shank", robot::solid::Cylinder{on_axis(6), on_axis(46), 5});
    add("holder", robot::solid::Cone{on_axis(46), on_axis(76), 12, 25});
    add("spindle", robot::solid::Cylinder{on_axis(76), on_axis(kToolLength), 30});
    return robot;
}

enum class Form { given, boxes, hulls, meshes };

robot::Solid as(Form form, const robot::Solid& solid)
{
    if (form == Form::given) return solid;
    mesh::Mesh mesh = robot::solid_mesh(solid);
    if (form == Form::hulls) return robot::solid::Hull{robot::hull_points(mesh.vertices)};
    if (form == Form::meshes) return robot::solid::Triangles{std::make_shared<robot::MeshBody>(std::move(mesh))};
    const Vector3d min = mesh.vertices.rowwise().minCoeff(), max = mesh.vertices.rowwise().maxCoeff();
    return robot::solid::Box{Isometry3d(Eigen::Translation3d((min + max) / 2)), (max - min) / 2};
}

/// The tool stays what it is: how a ball moves is bounded in closed form.
robot::Robot with_links(robot::Robot robot, Form form)
{
    for (robot::Body& body : robot.bodies)
        if (body.link != robot::link::kTool) body.solid = as(form, body.solid);
    return robot;
}

/// @return  seconds
double measure(const char* name, const robot::Robot& robot, const robot::Workpiece& workpiece,
               const robot::CellJointsPath& joints, double baseline)
{
    std::fflush(stdout);
    const double start = cpu_seconds();
    const robot::CheckedPath checked = robot::check_path(robot, &workpiece, joints, {});
    const double seconds = cpu_seconds() - start;
    const auto colliding = [](const std::vector<robot::CellClearance>& all) {
        return std::ranges::count_if(all, [](const robot::CellClearance& c) { return c.clearance < -0.01; });
    };
    std::size_t triangles = 0;
    for (const robot::Body& body : robot.bodies)
        if (const auto* of = std::get_if<robot::solid::Triangles>(&body.solid))
            triangles += of->body->mesh.triangles.cols();
    std::printf("%s (%zu triangles): %ld poses, %td collide, %td ways between: %.0f poses/s, %.2f of the first\n", name,
                triangles, joints.cols(), colliding(checked.at_poses), colliding(checked.between_poses),
                static_cast<double>(joints.cols()) / seconds, baseline > 0 ? baseline / seconds : 1.0);
    return seconds;
}

robot::CellJointsPath follow(const robot::Robot& robot, const cloud::PosePath& poses, const robot::Joints& start)
{
    const robot::ExternalChoice choice = robot::choose_externals(robot, poses, {});
    const robot::FollowedPath followed =
        robot::follow_path(robot, poses, robot::external_values(robot, poses, choice.track, choice.table), {start});
    std::printf("%td of %zu poses reached, %zu jumps\n", std::ranges::count(followed.state, robot::PoseState::reached),
                poses.size(), followed.jumps.size());
    return followed.joints;
}

} // namespace

int main()
{
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    constexpr int kRounds = 2;
    {
        const Vector3d place(450, 0, 50);
        const mesh::Mesh mesh = hull_at(place);
        const robot::Workpiece workpiece(mesh);
        const robot::Robot robot = ur5_with_tool();
        const robot::Joints kElbowUp = std::numbers::pi / 2 * (robot::Joints() << 0, -1, 1, -1, -1, 0).finished();
        const robot::CellJointsPath joints = follow(robot, path_at(place, 0), kElbowUp);
        for (int round = 0; round < kRounds; ++round) {
            const double boxes = measure("UR5, boxes", with_links(robot, Form::boxes), workpiece, joints, 0);
            measure("UR5, hulls", with_links(robot, Form::hulls), workpiece, joints, boxes);
            measure("UR5, meshes", robot, workpiece, joints, boxes);
        }
    }
    const Vector3d place(1000, 1000, 500);
    const mesh::Mesh mesh = hull_at(place);
    const robot::Workpiece workpiece(mesh);
    const robot::Robot robot = robot::read_robot("samples/robots/irb1400.json");
    const robot::CellJointsPath joints = follow(robot, path_at(place, std::numbers::pi), robot::Joints::Zero());
    for (int round = 0; round < kRounds; ++round) {
        const double given = measure("IRB 1400, as given", robot, workpiece, joints, 0);
        measure("IRB 1400, meshes", with_links(robot, Form::meshes), workpiece, joints, given);
    }
}
