// The cell of samples/robots/irb1400.json (arm, track, tool, fixture: 15 bodies) along 50,000 poses over a boat's hull
// of 100,000 triangles: all pairs at the poses, and between them. One core. The hull hangs over the bench.

#include "../lib/boat_hull.h"
#include "robot/clearance_tracker.h"
#include "robot/collision.h"
#include "robot/follow.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numbers>

using namespace fettle;

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr int kPoses = 50000, kTriangles = 100000, kRounds = 3;
const Vector3d kPlace(1000, 1000, 500);

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

cloud::PosePath path()
{
    cloud::PosePath poses = boat::poses(kPoses);
    for (Isometry3d& T : poses) {
        T = Eigen::Translation3d(kPlace) * T * Eigen::Translation3d(0, 0, -boat::kBall);
        T.linear() =
            T.linear() * Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()); // the bracket away from the robot
    }
    return poses;
}

} // namespace

int main(int argc, char** argv)
{
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const robot::Robot robot = robot::read_robot(argc > 1 ? argv[1] : "samples/robots/irb1400.json");
    mesh::Mesh mesh = boat::hull(kTriangles);
    mesh.vertices.colwise() += kPlace;
    const robot::Workpiece workpiece(mesh);
    const cloud::PosePath poses = path();
    const robot::ExternalChoice choice = robot::choose_externals(robot, poses, {});
    const robot::FollowedPath followed =
        robot::follow_path(robot, poses, robot::external_values(robot, poses, choice.track, choice.table));
    const robot::Cell cell(robot, &workpiece, {});
    for (int round = 0; round < kRounds; ++round) {
        double start = cpu_seconds();
        robot::ClearanceTracker tracker(cell);
        int reached = 0, colliding = 0;
        for (const auto q : followed.joints.colwise()) {
            if (robot::CellJoints(q).hasNaN()) continue;
            ++reached;
            colliding += tracker.advance(q).clearance < -0.01;
        }
        const double at_poses = cpu_seconds() - start;
        start = cpu_seconds();
        const robot::CheckedPath checked = robot::check_path(robot, &workpiece, followed.joints, {});
        const double all = cpu_seconds() - start;
        const auto between = std::count_if(checked.between_poses.begin(), checked.between_poses.end(),
                                           [](const robot::CellClearance& c) { return c.clearance < -0.01; });
        std::printf(
            "%d poses reached, %zu jumps, %d collide, %ld ways between: at the poses %.0f poses/s, between them, "
            "too, %.0f poses/s with %.1f looks a way\n",
            reached, followed.jumps.size(), colliding, between, reached / at_poses, reached / all,
            static_cast<double>(checked.midpoint_count) / reached);
    }
}
