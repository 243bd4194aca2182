#include "robot/avoid_trial.h"

#include "core/constants.h"

#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Does the body's place not depend on the arm's joints, but on track and table only?
bool is_off_arm(const Robot& robot, std::size_t body)
{
    if (body == robot.bodies.size()) return true; // the workpiece
    const int on = robot.bodies[body].link;
    return on == link::kCell || on == link::kBase || on == link::kTable;
}

bool on_tool(const Robot& robot, std::size_t body)
{
    return body < robot.bodies.size() && robot.bodies[body].link == link::kTool;
}

// Distance of the body's farthest point from the pivot, mm; 0 for a sphere about it, which a tilt leaves in its place.
double lever_of(const Solid& solid, const Vector3d& pivot)
{
    const auto* ball = std::get_if<solid::Sphere>(&solid);
    if (ball != nullptr && ball->centre == pivot) return 0;
    const Eigen::AlignedBox3d box = PlacedSolid(solid, Isometry3d::Identity()).bounding_box();
    return ((box.max() - pivot).cwiseAbs()).cwiseMax((box.min() - pivot).cwiseAbs()).norm();
}

// Options for the question whether something collides: larger clearances need not be known.
CollisionOptions decision_options(CollisionOptions options)
{
    options.max_clearance = options.tolerance;
    return options;
}

// Shifts each joint by whole turns to be nearest to `seed`, where the range allows it.
Joints wrap_near(const Robot& robot, Joints q, const CellJoints& seed)
{
    for (Eigen::Index k = 0; k < 6; ++k) {
        const double nearest = q[k] + 2 * std::numbers::pi * std::round((seed[k] - q[k]) / (2 * std::numbers::pi));
        if (robot.dh[k].range.contains(nearest)) q[k] = nearest;
    }
    return q;
}

} // namespace

ChangeChecker::ChangeChecker(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options,
                             const SolvedPath& solved, const Eigen::Matrix3Xd& retreat_directions)
    : robot_(robot), solved_(solved), retreat_directions_(retreat_directions), options_(decision_options(options)),
      cell_(robot, workpiece, options_), arm_(robot), pivot_(tilt_pivot(robot))
{
    for (const std::size_t i : cell_.active_pairs()) {
        const CellPair& pair = cell_.pairs()[i];
        const bool is_tool_pair = (on_tool(robot, pair.a) && is_off_arm(robot, pair.b)) ||
                                  (on_tool(robot, pair.b) && is_off_arm(robot, pair.a));
        (is_tool_pair ? tool_pairs_ : arm_pairs_).push_back(i);
    }
    for (const Body& body : robot.bodies) levers_.push_back(lever_of(body.solid, {0, 0, pivot_}));
}

Isometry3d ChangeChecker::tool_pose(Eigen::Index i, const PoseChange& change) const
{
    return changed_pose(solved_.poses[i], change, pivot_, retreat_directions_.col(i));
}

CellJoints ChangeChecker::seed_joints(Eigen::Index i) const
{
    for (Eigen::Index k = i; k >= 0; --k)
        if (!solved_.path.joints.col(k).hasNaN()) return solved_.path.joints.col(k);
    return CellJoints::Zero();
}

CellJoints ChangeChecker::nearest_joints(Eigen::Index i, const PoseChange& change, const CellJoints& seed) const
{
    const Eigen::Vector2d external = solved_.external_values.col(i);
    CellJoints nearest = CellJoints::Constant(core::kNaN);
    if (robot_.track && !robot_.track->range.contains(external[0])) return nearest;
    if (robot_.table && !robot_.table->range.contains(external[1])) return nearest;
    const Isometry3d flange = flange_target(robot_, tool_pose(i, change), external[0], external[1]);
    double min_motion = core::kInfinity;
    for (const ArmSolution& solution : arm_.solve(flange, seed.head<6>(), Ranges::respect)) {
        const Joints q = wrap_near(robot_, solution.joints, seed);
        const double motion = (q - seed.head<6>()).squaredNorm();
        if (motion >= min_motion) continue;
        min_motion = motion;
        nearest << q, external;
    }
    return nearest;
}

bool ChangeChecker::arm_is_clear(const CellJoints& joints) const
{
    CellState state = cell_.place_bodies(joints);
    for (const std::size_t i : arm_pairs_) {
        cell_.measure_clearance(state, i);
        if (state.clearances[i].clearance < -options_.tolerance) return false;
    }
    return true;
}

CellJoints ChangeChecker::find_clear_joints(Eigen::Index i, const PoseChange& change, const CellJoints& seed,
                                            CollidingChanges& blocked) const
{
    const CellJoints q = nearest_joints(i, change, seed);
    if (q.hasNaN()) return q;
    CellState state = cell_.place_bodies(q);
    for (const std::size_t k : tool_pairs_) {
        cell_.measure_clearance(state, k);
        const CellPair& pair = cell_.pairs()[k];
        const double depth = -state.clearances[k].clearance - options_.tolerance;
        if (!(depth > 0)) continue;
        // A workpiece model changes its geometry with the tool's pose: a result at one tilt does not hold at another.
        if (options_.model == nullptr || pair.b < robot_.bodies.size())
            blocked.add(change, depth, levers_[on_tool(robot_, pair.a) ? pair.a : pair.b]);
        return CellJoints::Constant(core::kNaN);
    }
    return arm_is_clear(q) ? q : CellJoints::Constant(core::kNaN);
}

} // namespace fettle::robot
