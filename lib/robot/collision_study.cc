#include "robot/collision_study.h"

#include "cloud/poses.h"
#include "core/error.h"
#include "robot/arm_report.h"
#include "robot/avoid_report.h"
#include "robot/cell.h"
#include "robot/collision_report.h"
#include "robot/path_cloud.h"

#include <algorithm>
#include <vector>

namespace fettle::robot {

namespace {

// Whether nothing collides that track and table could keep apart: the flange and all beyond it are where the pose has
// them, relative to the part and the table, whatever the others do.
IsClear clear_of_arm(const Cell& cell, const Robot& robot)
{
    const auto goes_with_pose = [&](std::size_t body) {
        const int on = body < robot.bodies.size() ? robot.bodies[body].link : workpiece_link(robot);
        return on == 6 || on == link::kTool || on == link::kTable;
    };
    std::vector<std::size_t> pairs;
    for (const std::size_t pair : cell.active_pairs()) {
        const auto& [a, b, margin] = cell.pairs()[pair];
        const bool on_part = cell.is_of_workpiece(pair) && goes_with_pose(a); // without a table, too
        if (!on_part && !(goes_with_pose(a) && goes_with_pose(b))) pairs.push_back(pair);
    }
    return [&cell, pairs](const CellJoints& joints) {
        const double tolerance = cell.options().tolerance;
        CellState state = cell.place_bodies(joints);
        return std::ranges::all_of(pairs, [&](std::size_t pair) {
            return cell.ball_clearance(state, pair) > 0 || cell.measure_clearance(state, pair, 0) >= -tolerance;
        });
    };
}

} // namespace

CollisionStudy study_collisions(const Robot& robot, const cloud::Cloud& path, const std::string& source, double mm,
                                const Workpiece* workpiece, const CollisionRequest& request,
                                const core::Progress& progress)
{
    CollisionStudy study;
    study.request = request;
    const Cell cell(robot, workpiece, request.collision);
    study.solved = core::with_error_prefix(
        source, [&] { return solve_path(robot, path, request.path, mm, clear_of_arm(cell, robot)); });
    CollisionOptions& options = study.request.collision;
    if (request.model) {
        if (workpiece == nullptr) throw core::InputError("--method", "needs a --workpiece");
        study.model = std::make_unique<HeterogeneousModel>(*workpiece, tool_axes(study.solved.poses), *request.model);
    }
    options.model = study.model.get();
    study.checked = check_path(robot, workpiece, study.solved.path.joints, options, progress);
    study.before = study.checked;
    if (!request.avoid) return study;
    study.avoided = avoid_collisions(robot, workpiece, study.solved, study.before,
                                     retreat_directions(path, study.solved.poses), *request.avoid, options);
    study.solved.poses = study.avoided->poses;
    study.solved.path = study.avoided->path;
    study.checked = study.avoided->checked;
    return study;
}

void set_fields(cloud::Cloud& path, const Robot& robot, const CollisionStudy& study)
{
    cloud::set_poses(path, study.solved.poses);
    set_joints(path, robot, study.solved.path.joints);
    set_states(path, study.solved.path);
    set_clearances(path, robot, study.checked);
    if (study.avoided) set_changes(path, *study.avoided, study.request.collision.tolerance);
}

bool add_report(json::Value& report, const Robot& robot, const CollisionStudy& study,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units)
{
    const CollisionOptions& options = study.request.collision;
    if (study.avoided) add_report(report, robot, *study.avoided, study.before, *study.request.avoid, options, units);
    const bool runs = add_report(report, robot, study.solved.path, 0, times, units);
    const bool clear = add_report(report, robot, study.checked, options, times, units);
    return runs && clear;
}

} // namespace fettle::robot
