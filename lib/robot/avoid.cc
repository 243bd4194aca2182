#include "robot/avoid.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index;

// A path while it is led around.
struct Work {
    const Robot& robot;
    const Workpiece* workpiece;
    const SolvedPath& solved;
    const AvoidOptions& options;
    const CollisionOptions& collision;
    const Eigen::Matrix3Xd& away;
    Led led;
    CheckedPath checked;

    Trials trials() const { return {robot, workpiece, collision, solved, away}; }
    bool collides(const CellClearance& c) const { return c.clearance < -collision.tolerance; }
};

// Looks again at some poses and at the ways to and from them, as at a path of its own whose pieces NaN keeps apart.
void look_again(Work& work, const std::vector<bool>& changed)
{
    const std::size_t count = changed.size();
    const auto seen = [&](std::size_t i) {
        return changed[i] || (i > 0 && changed[i - 1]) || (i + 1 < count && changed[i + 1]);
    };
    std::vector<std::size_t> from; // count: a gap
    for (std::size_t i = 0; i < count; ++i)
        if (seen(i))
            from.push_back(i);
        else if (!from.empty() && from.back() != count)
            from.push_back(count);
    CellJointsPath joints(8, static_cast<Index>(from.size()));
    for (std::size_t k = 0; k < from.size(); ++k) {
        auto column = joints.col(static_cast<Index>(k));
        column.setConstant(std::numeric_limits<double>::quiet_NaN());
        if (from[k] < count) column = work.led.joints.col(static_cast<Index>(from[k]));
    }
    const CheckedPath again = check_path(work.robot, work.workpiece, joints, work.collision);
    for (std::size_t k = 0; k < from.size(); ++k) {
        if (from[k] == count) continue;
        work.checked.pose[from[k]] = again.pose[k];
        if (k > 0 && from[k - 1] != count) work.checked.between[from[k]] = again.between[k];
    }
    work.checked.looks += again.looks;
}

std::vector<bool> changed_from(const Work& work, const std::vector<PoseChange>& before)
{
    std::vector<bool> changed(before.size());
    for (std::size_t i = 0; i < before.size(); ++i) changed[i] = work.led.changes[i] != before[i];
    return changed;
}

// How deep each pose collides, mm; infinite where it is not reached, 0 where there is nothing to do.
std::vector<double> depths(const Work& work)
{
    std::vector<double> depth(work.led.changes.size(), 0);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const PoseState state = work.solved.path.state[i];
        if (state == PoseState::undefined) continue;
        if (state != PoseState::reached && work.led.changes[i] == PoseChange())
            depth[i] = kInfinity;
        else
            depth[i] = std::max(0.0, -work.collision.tolerance - work.checked.pose[i].clearance);
    }
    return depth;
}

// One search for tilts, from the poses as they are.
void tilt(Work& work, bool smooth)
{
    const Trials trials = work.trials();
    const std::vector<PoseChange> before = work.led.changes;
    const std::vector<double> depth = depths(work);
    if (smooth) {
        tilt_smoothly(trials, depth, work.options, work.led);
    } else {
        std::vector<bool> trouble(depth.size());
        std::transform(depth.begin(), depth.end(), trouble.begin(), [](double d) { return d > 0; });
        tilt_by_pose(trials, trouble, work.options, work.led);
    }
    look_again(work, changed_from(work, before));
}

// Ways that collide although their ends do not, by the pose behind.
std::vector<std::size_t> bad_ways(const Work& work)
{
    std::vector<std::size_t> ways;
    for (std::size_t i = 1; i < work.led.changes.size(); ++i)
        if (work.collides(work.checked.between[i]) && !work.collides(work.checked.pose[i]) &&
            !work.collides(work.checked.pose[i - 1]))
            ways.push_back(i);
    return ways;
}

// Changes a pose, if it is clear so.
void change(Work& work, const Trials& trials, std::size_t pose, const PoseChange& change)
{
    const auto column = static_cast<Index>(pose);
    Blocked blocked;
    const CellJoints q = trials.look(column, change, work.led.joints.col(column), blocked);
    if (q.hasNaN()) return;
    work.led.changes[pose] = change;
    work.led.joints.col(column) = q;
}

// Ends of ways that touch the workpiece draw back one step more. On others along which the tilt changes, the end that
// leans less takes the tilt of the other: the change comes earlier or later.
void change_ends(Work& work, const std::vector<CellPair>& pairs)
{
    const Trials trials = work.trials();
    std::size_t drawn_back = 0; // this pose has been so by the way before
    for (const std::size_t i : bad_ways(work)) {
        const PoseChange &a = work.led.changes[i - 1], &b = work.led.changes[i];
        if (pairs[work.checked.between[i].pair].b == work.robot.bodies.size()) {
            for (const std::size_t end : {i - 1, i}) {
                PoseChange back = work.led.changes[end];
                back.retreat += kRetreatStep;
                if (end != drawn_back && back.retreat <= work.options.most_retreat * (1 + 1e-9))
                    change(work, trials, end, back);
            }
            drawn_back = i;
        } else if (a.tilt != b.tilt) {
            const bool first = a.tilt.norm() < b.tilt.norm();
            change(work, trials, first ? i - 1 : i, {first ? b.tilt : a.tilt, first ? a.retreat : b.retreat});
        }
    }
}

// A retreat that has not helped is taken back.
void take_back(Work& work, const Led& before)
{
    for (const std::size_t way : bad_ways(work))
        for (const std::size_t i : {way - 1, way})
            change(work, work.trials(), i, {work.led.changes[i].tilt, before.changes[i].retreat});
}

void part_ways(Work& work)
{
    const Led before = work.led;
    const std::vector<CellPair> pairs = checked_pairs(work.robot);
    const auto rounds = static_cast<int>(work.options.most_retreat / kRetreatStep * (1 + 1e-9)) + 1;
    for (int k = 0; k <= rounds; ++k) {
        const std::vector<PoseChange> last = work.led.changes;
        if (k < rounds)
            change_ends(work, pairs);
        else
            take_back(work, before);
        const std::vector<bool> changed = changed_from(work, last);
        if (std::find(changed.begin(), changed.end(), true) == changed.end()) continue;
        look_again(work, changed);
    }
}

FollowedPath followed(const Work& work)
{
    FollowedPath path = judge(work.robot, work.led.joints, work.options.jump);
    const FollowedPath& given = work.solved.path;
    path.blocked.setZero();
    for (std::size_t i = 0; i < path.state.size(); ++i) {
        if (path.state[i] == PoseState::undefined) path.state[i] = given.state[i];
        if (work.led.changes[i] == PoseChange()) path.branch[i] = given.branch[i];
    }
    return path;
}

} // namespace

AvoidedPath avoid(const Robot& robot, const Workpiece* workpiece, const SolvedPath& solved, const CheckedPath& before,
                  const Eigen::Matrix3Xd& away, const AvoidOptions& options, const CollisionOptions& collision)
{
    const std::size_t count = solved.poses.size();
    Work work{robot, workpiece, solved, options, collision, away, {std::vector<PoseChange>(count), solved.path.joints},
              before};
    tilt(work, options.smooth);
    if (options.smooth) tilt(work, false);
    part_ways(work);
    AvoidedPath avoided{{}, followed(work), work.checked, work.led.changes};
    const Trials trials = work.trials();
    for (std::size_t i = 0; i < count; ++i)
        avoided.poses.push_back(trials.pose(static_cast<Index>(i), work.led.changes[i]));
    return avoided;
}

} // namespace fettle
