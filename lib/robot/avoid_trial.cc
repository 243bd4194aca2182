#include "robot/avoid_trial.h"

#include "core/constants.h"

#include <cmath>
#include <numbers>

namespace fettle {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Whether a body stands still, whatever the arm does, once track and table stand.
bool stands(const Robot& robot, std::size_t body)
{
    if (body == robot.bodies.size()) return true;
    const int on = robot.bodies[body].link;
    return on == link::kCell || on == link::kBase || on == link::kTable;
}

bool on_tool(const Robot& robot, std::size_t body)
{
    return body < robot.bodies.size() && robot.bodies[body].link == link::kTool;
}

// How far the body's points lie from the pivot, mm; 0 for a ball about it, which turns in its place.
double lever_of(const Solid& solid, const Vector3d& pivot)
{
    const auto* ball = std::get_if<solid::Sphere>(&solid);
    if (ball != nullptr && ball->centre == pivot) return 0;
    const Eigen::AlignedBox3d box = PlacedSolid(solid, Isometry3d::Identity()).box();
    return ((box.max() - pivot).cwiseAbs()).cwiseMax((box.min() - pivot).cwiseAbs()).norm();
}

CollisionOptions just_enough(CollisionOptions options)
{
    options.beyond = options.tolerance; // more is not asked for
    return options;
}

// The whole turns of each joint that are nearest to others, where the range allows them.
Joints turned_near(const Robot& robot, Joints q, const CellJoints& near)
{
    for (Eigen::Index k = 0; k < 6; ++k) {
        const double nearer = q[k] + 2 * std::numbers::pi * std::round((near[k] - q[k]) / (2 * std::numbers::pi));
        if (within(robot.dh[static_cast<std::size_t>(k)].range, nearer)) q[k] = nearer;
    }
    return q;
}

} // namespace

Trials::Trials(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options,
               const SolvedPath& solved, const Eigen::Matrix3Xd& away)
    : robot_(robot), solved_(solved), away_(away), options_(just_enough(options)), cell_(robot, workpiece, options_),
      arm_(robot), pivot_(tilt_pivot(robot))
{
    for (const std::size_t i : cell_.looked_at()) {
        const CellPair& pair = cell_.pairs()[i];
        const bool tool_alone =
            (on_tool(robot, pair.a) && stands(robot, pair.b)) || (on_tool(robot, pair.b) && stands(robot, pair.a));
        (tool_alone ? of_tool_ : of_arm_).push_back(i);
    }
    for (const Body& body : robot.bodies) lever_.push_back(lever_of(body.solid, {0, 0, pivot_}));
}

Isometry3d Trials::pose(Eigen::Index i, const PoseChange& change) const
{
    return changed_pose(solved_.poses[static_cast<std::size_t>(i)], change, pivot_, away_.col(i));
}

CellJoints Trials::near(Eigen::Index i) const
{
    for (Eigen::Index k = i; k >= 0; --k)
        if (!solved_.path.joints.col(k).hasNaN()) return solved_.path.joints.col(k);
    return CellJoints::Zero();
}

CellJoints Trials::joints(Eigen::Index i, const PoseChange& change, const CellJoints& near) const
{
    const Eigen::Vector2d external = solved_.external_values.col(i);
    CellJoints nearest = CellJoints::Constant(kNaN);
    if (robot_.track && !within(robot_.track->range, external[0])) return nearest;
    if (robot_.table && !within(robot_.table->range, external[1])) return nearest;
    const Isometry3d flange = flange_for(robot_, pose(i, change), external[0], external[1]);
    double least = std::numeric_limits<double>::infinity();
    for (const ArmSolution& solution : arm_.solve(flange, near.head<6>(), Ranges::respect)) {
        const Joints q = turned_near(robot_, solution.joints, near);
        const double motion = (q - near.head<6>()).squaredNorm();
        if (motion >= least) continue;
        least = motion;
        nearest << q, external;
    }
    return nearest;
}

bool Trials::clear_of_arm(const CellJoints& joints) const
{
    Stance stance = cell_.stand(joints);
    for (const std::size_t i : of_arm_) {
        cell_.look(stance, i);
        if (stance.pairs[i].clearance < -options_.tolerance) return false;
    }
    return true;
}

CellJoints Trials::look(Eigen::Index i, const PoseChange& change, const CellJoints& near, Blocked& blocked) const
{
    const CellJoints q = joints(i, change, near);
    if (q.hasNaN()) return q;
    Stance stance = cell_.stand(q);
    for (const std::size_t k : of_tool_) {
        cell_.look(stance, k);
        const CellPair& pair = cell_.pairs()[k];
        const double depth = -stance.pairs[k].clearance - options_.tolerance;
        if (!(depth > 0)) continue;
        // With the tool another part of a model turns into triangles: what is known of one tilt says nothing of others.
        if (options_.model == nullptr || pair.b < robot_.bodies.size())
            blocked.add(change, depth, lever_[on_tool(robot_, pair.a) ? pair.a : pair.b]);
        return CellJoints::Constant(kNaN);
    }
    return clear_of_arm(q) ? q : CellJoints::Constant(kNaN);
}

} // namespace fettle
