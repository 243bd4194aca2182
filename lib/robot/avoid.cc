#include "robot/avoid.h"

#include "core/constants.h"

#include <algorithm>

namespace fettle::robot {

namespace {

// The path in its present state, with what it is checked against.
struct Work {
    const Robot& robot;
    const Workpiece* workpiece;
    const SolvedPath& solved;
    const AvoidOptions& options;
    const CollisionOptions& collision;
    const Eigen::Matrix3Xd& retreat_directions;
    ChangedPath path;
    CheckedPath checked; ///< clearances of `path`

    ChangeChecker trials() const { return {robot, workpiece, collision, solved, retreat_directions}; }
    bool collides(const CellClearance& c) const { return c.clearance < -collision.tolerance; }
};

// Renews the clearances of the poses whose changes differ from `before`, and of the motions to and from them: together
// they are checked as one path, with a NaN pose between sections that are not connected.
void recheck(Work& work, const std::vector<PoseChange>& before)
{
    const std::size_t count = before.size(), gap = count;
    const auto changed = [&](std::size_t i) { return work.path.changes[i] != before[i]; };
    std::vector<std::size_t> indices; // of the poses to check
    for (std::size_t i = 0; i < count; ++i)
        if (changed(i) || (i > 0 && changed(i - 1)) || (i + 1 < count && changed(i + 1)))
            indices.push_back(i);
        else if (!indices.empty() && indices.back() != gap)
            indices.push_back(gap);
    if (indices.empty()) return;
    CellJointsPath joints = CellJointsPath::Constant(8, indices.size(), core::kNaN);
    for (std::size_t k = 0; k < indices.size(); ++k)
        if (indices[k] != gap) joints.col(k) = work.path.joints.col(indices[k]);
    const CheckedPath again = check_path(work.robot, work.workpiece, joints, work.collision);
    for (std::size_t k = 0; k < indices.size(); ++k) {
        if (indices[k] == gap) continue;
        work.checked.at_poses[indices[k]] = again.at_poses[k];
        if (k > 0 && indices[k - 1] != gap) work.checked.between_poses[indices[k]] = again.between_poses[k];
    }
    work.checked.midpoint_count += again.midpoint_count;
}

// Penetration depth of each pose beyond the tolerance, mm: infinite if it is not reached, 0 if it need not change.
std::vector<double> depths(const Work& work)
{
    std::vector<double> depth(work.path.changes.size(), 0);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const PoseState state = work.solved.path.state[i];
        if (state == PoseState::undefined) continue;
        if (state != PoseState::reached && work.path.changes[i] == PoseChange())
            depth[i] = core::kInfinity;
        else
            depth[i] = std::max(0.0, -work.collision.tolerance - work.checked.at_poses[i].clearance);
    }
    return depth;
}

void tilt(Work& work, bool smooth)
{
    const ChangeChecker trials = work.trials();
    const std::vector<PoseChange> before = work.path.changes;
    const std::vector<double> depth = depths(work);
    if (smooth) {
        tilt_smoothly(trials, depth, work.options, work.path);
    } else {
        std::vector<bool> must_change(depth.size());
        std::transform(depth.begin(), depth.end(), must_change.begin(), [](double d) { return d > 0; });
        tilt_by_pose(trials, must_change, work.options, work.path);
    }
    recheck(work, before);
}

// Motions that collide between poses that do not, by the index of the second pose.
std::vector<std::size_t> colliding_motions(const Work& work)
{
    std::vector<std::size_t> motions;
    for (std::size_t i = 1; i < work.path.changes.size(); ++i)
        if (work.collides(work.checked.between_poses[i]) && !work.collides(work.checked.at_poses[i]) &&
            !work.collides(work.checked.at_poses[i - 1]))
            motions.push_back(i);
    return motions;
}

// Changes a pose, unless it would then collide or not be reached.
void try_change(Work& work, const ChangeChecker& trials, std::size_t pose, const PoseChange& change)
{
    CollidingChanges colliding;
    const CellJoints q = trials.find_clear_joints(pose, change, work.path.joints.col(pose), colliding);
    if (q.hasNaN()) return;
    work.path.changes[pose] = change;
    work.path.joints.col(pose) = q;
}

// If a motion collides with the workpiece, both of its poses retreat one more step. If it collides otherwise and the
// tilt changes on it, the pose with the smaller tilt takes the tilt of the other, which moves the change of tilt.
void change_ends(Work& work, const std::vector<CellPair>& pairs)
{
    const ChangeChecker trials = work.trials();
    std::size_t retreated = 0; // the last pose that retreated because of the motion before
    for (const std::size_t i : colliding_motions(work)) {
        const PoseChange &a = work.path.changes[i - 1], &b = work.path.changes[i];
        if (pairs[work.checked.between_poses[i].pair].b == work.robot.bodies.size()) {
            for (const std::size_t end : {i - 1, i}) {
                PoseChange change = work.path.changes[end];
                change.retreat += kRetreatStep;
                if (end != retreated && change.retreat <= work.options.max_retreat * (1 + 1e-9))
                    try_change(work, trials, end, change);
            }
            retreated = i;
        } else if (a.tilt != b.tilt) {
            const bool first = a.tilt.norm() < b.tilt.norm();
            try_change(work, trials, first ? i - 1 : i, {first ? b.tilt : a.tilt, first ? a.retreat : b.retreat});
        }
    }
}

// Undoes the retreats of motions that still collide.
void undo_retreats(Work& work, const std::vector<PoseChange>& before)
{
    const ChangeChecker trials = work.trials();
    for (const std::size_t motion : colliding_motions(work))
        for (const std::size_t i : {motion - 1, motion})
            try_change(work, trials, i, {work.path.changes[i].tilt, before[i].retreat});
}

void clear_motions(Work& work)
{
    const std::vector<PoseChange> before = work.path.changes;
    const std::vector<CellPair> pairs = checked_pairs(work.robot);
    const int rounds = int(work.options.max_retreat / kRetreatStep * (1 + 1e-9)) + 1;
    for (int k = 0; k <= rounds; ++k) {
        const std::vector<PoseChange> last = work.path.changes;
        if (k < rounds)
            change_ends(work, pairs);
        else
            undo_retreats(work, before);
        recheck(work, last);
    }
}

// The states of the changed path. Poses without joints keep their state, unchanged poses their branch.
FollowedPath changed_states(const Work& work)
{
    FollowedPath path = evaluate_joints(work.robot, work.path.joints, work.options.jump_threshold);
    const FollowedPath& given = work.solved.path;
    path.out_of_range_counts.setZero();
    for (std::size_t i = 0; i < path.state.size(); ++i) {
        if (path.state[i] == PoseState::undefined) path.state[i] = given.state[i];
        if (work.path.changes[i] == PoseChange()) path.branch[i] = given.branch[i];
    }
    return path;
}

} // namespace

AvoidedPath avoid_collisions(const Robot& robot, const Workpiece* workpiece, const SolvedPath& solved,
                             const CheckedPath& before, const Eigen::Matrix3Xd& retreat_directions,
                             const AvoidOptions& options, const CollisionOptions& collision)
{
    const std::size_t count = solved.poses.size();
    Work work{robot,
              workpiece,
              solved,
              options,
              collision,
              retreat_directions,
              {std::vector<PoseChange>(count), solved.path.joints},
              before};
    tilt(work, options.smooth);
    if (options.smooth) tilt(work, false);
    clear_motions(work);
    AvoidedPath avoided{{}, changed_states(work), work.checked, work.path.changes};
    const ChangeChecker trials = work.trials();
    for (std::size_t i = 0; i < count; ++i) avoided.poses.push_back(trials.tool_pose(i, work.path.changes[i]));
    return avoided;
}

} // namespace fettle::robot
