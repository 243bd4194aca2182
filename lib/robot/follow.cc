#include "robot/follow.h"

#include "core/constants.h"
#include "robot/arm.h"
#include "robot/layered_search.h"

#include <algorithm>

namespace fettle::robot {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Adds a solution with all combinations of whole turns of the joints from `joint` on that stay in range.
void add_turns(const Robot& robot, const ArmSolution& solution, Eigen::Index joint, std::vector<ArmSolution>& all)
{
    if (joint == 6) {
        all.push_back(solution);
        return;
    }
    const JointRange& range = robot.dh[joint].range;
    ArmSolution turned = solution;
    double& q = turned.joints[joint];
    while (range.contains(q - kTurn)) q -= kTurn;
    for (; range.contains(q); q += kTurn) add_turns(robot, turned, joint + 1, all);
}

class PathSearch {
  public:
    PathSearch(const Robot& robot, const FollowOptions& options) : robot_(robot), options_(options) {}

    /// Adds a pose. @param after_gap  does it not follow directly on the pose added before?
    /// @return  false if no solution is in range
    bool add(const ArmSolutions& solutions, bool after_gap)
    {
        std::vector<ArmSolution> here;
        for (const ArmSolution& solution : solutions) add_turns(robot_, solution, 0, here);
        if (here.empty()) return false;
        search_.add(here.size(), [&](std::size_t from, std::size_t to) -> ViterbiSearch::Cost {
            if (layers_.empty()) return {0, (here[to].joints - options_.start).squaredNorm()};
            const Joints move = here[to].joints - layers_.back()[from].joints;
            return {!after_gap && move.cwiseAbs().maxCoeff() > options_.jump_threshold ? 1 : 0, move.squaredNorm()};
        });
        layers_.push_back(std::move(here));
        return true;
    }

    /// The last joints of the best path so far.
    const Joints& last_joints() const
    {
        return layers_.empty() ? options_.start : layers_.back()[search_.best_end()].joints;
    }

    /// The best path: a solution for each pose that was added.
    std::vector<ArmSolution> path() const
    {
        std::vector<ArmSolution> path;
        for (const std::size_t i : search_.path()) path.push_back(layers_[path.size()][i]);
        return path;
    }

  private:
    const Robot& robot_;
    const FollowOptions& options_;
    ViterbiSearch search_;
    std::vector<std::vector<ArmSolution>> layers_; // solutions of each pose that was added
};

struct BlockingJoint {
    Eigen::Index joint = 0;
    double value = core::kNaN; // rad
};

// The joint that is farthest out of its range, in the solution for which this is the smallest excess.
BlockingJoint blocking_joint(const Robot& robot, const Arm& arm, const Eigen::Isometry3d& flange)
{
    double min_excess = core::kInfinity;
    BlockingJoint blocking;
    for (const ArmSolution& solution : arm.solve(flange, Joints::Zero(), Ranges::ignore)) {
        Joints excess;
        for (Eigen::Index k = 0; k < 6; ++k) {
            const JointRange& range = robot.dh[k].range;
            excess[k] = std::max(range.min - solution.joints[k], solution.joints[k] - range.max);
        }
        Eigen::Index worst = 0;
        const double max = excess.maxCoeff(&worst);
        if (max < min_excess) {
            min_excess = max;
            blocking = {worst, solution.joints[worst]};
        }
    }
    return blocking;
}

// The index of the track (6) or table (7) if it is out of its range, else -1.
Eigen::Index external_out_of_range(const Robot& robot, const Eigen::Vector2d& external)
{
    if (robot.track && !robot.track->range.contains(external[0])) return 6;
    if (robot.table && !robot.table->range.contains(external[1])) return 7;
    return -1;
}

FollowedPath undefined_path(Eigen::Index count)
{
    FollowedPath path;
    path.joints = CellJointsPath::Constant(8, count, core::kNaN);
    path.state.assign(count, PoseState::undefined);
    path.branch.assign(count, -1);
    path.joint_out_of_range.assign(count, -1);
    path.singularity = Eigen::VectorXd::Constant(count, core::kNaN);
    path.obstacle_value = Eigen::VectorXd::Constant(count, core::kNaN);
    path.out_of_range_counts.setZero();
    return path;
}

void set_out_of_range(FollowedPath& path, Eigen::Index pose, Eigen::Index joint, double value)
{
    path.obstacle_value[pose] = value;
    path.state[pose] = PoseState::out_of_range;
    path.joint_out_of_range[pose] = static_cast<int>(joint);
    ++path.out_of_range_counts[joint];
}

// Jumps of all rotary axes. The table counts: one that follows the tip may have to turn back at an end of its range.
std::vector<Eigen::Index> find_jumps(const CellJointsPath& joints, double jump_threshold)
{
    std::vector<Eigen::Index> jumps;
    for (Eigen::Index i = 1; i < joints.cols(); ++i) {
        CellJoints turn = (joints.col(i) - joints.col(i - 1)).cwiseAbs();
        turn[6] *= 0; // mm; still NaN where there is no pose
        if (turn.maxCoeff<Eigen::PropagateNaN>() > jump_threshold) jumps.push_back(i);
    }
    return jumps;
}

} // namespace

std::vector<std::pair<int, Joints>> all_solutions(const Robot& robot, const Eigen::Isometry3d& T_base_flange)
{
    std::vector<ArmSolution> solutions;
    for (const ArmSolution& solution : Arm(robot).solve(T_base_flange, Joints::Zero(), Ranges::respect))
        add_turns(robot, solution, 0, solutions);
    std::vector<std::pair<int, Joints>> all;
    for (const auto& [joints, branch] : solutions) all.emplace_back(branch, joints);
    return all;
}

FollowedPath follow_path(const Robot& robot, const cloud::PosePath& poses, const Eigen::Matrix2Xd& externals,
                         const FollowOptions& options)
{
    const Arm arm(robot);
    const Eigen::Index count = poses.size();
    FollowedPath path = undefined_path(count);
    PathSearch search(robot, options);
    Eigen::Index last = -1; // the last pose reached
    for (Eigen::Index i = 0; i < count; ++i) {
        PoseState& state = path.state[i];
        const Eigen::Isometry3d& pose = poses[i];
        if (pose.translation().hasNaN()) continue;
        const Eigen::Isometry3d flange = flange_target(robot, pose, externals(0, i), externals(1, i));
        const Eigen::Index external = external_out_of_range(robot, externals.col(i));
        const ArmSolutions solutions = arm.solve(flange, search.last_joints(), Ranges::respect);
        if (external < 0 && search.add(solutions, last != i - 1)) {
            state = PoseState::reached;
            last = i;
        } else if (external >= 0 || solutions.reachable) {
            const BlockingJoint blocking = external >= 0 ? BlockingJoint{external, externals(external - 6, i)}
                                                         : blocking_joint(robot, arm, flange);
            set_out_of_range(path, i, blocking.joint, blocking.value);
        } else {
            state = PoseState::unreachable;
            path.obstacle_value[i] = flange.translation().norm();
        }
    }
    const std::vector<ArmSolution> solutions = search.path();
    std::size_t reached = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        if (path.state[i] != PoseState::reached) continue;
        const auto& [joints, branch] = solutions[reached++];
        path.joints.col(i) << joints, externals.col(i);
        path.branch[i] = branch;
        path.singularity[i] = arm.singularity(joints).min();
    }
    path.jumps = find_jumps(path.joints, options.jump_threshold);
    return path;
}

FollowedPath evaluate_joints(const Robot& robot, const CellJointsPath& joints, double jump_threshold)
{
    const Arm arm(robot);
    FollowedPath path = undefined_path(joints.cols());
    path.joints = joints;
    for (Eigen::Index i = 0; i < joints.cols(); ++i) {
        const CellJoints q = joints.col(i);
        if (q.hasNaN()) continue;
        Eigen::Index out_of_range = external_out_of_range(robot, q.tail<2>());
        for (Eigen::Index k = 5; k >= 0; --k)
            if (!robot.dh[k].range.contains(q[k])) out_of_range = k;
        path.state[i] = PoseState::reached;
        if (out_of_range >= 0) set_out_of_range(path, i, out_of_range, q[out_of_range]);
        path.singularity[i] = arm.singularity(q.head<6>()).min();
    }
    path.jumps = find_jumps(joints, jump_threshold);
    return path;
}

} // namespace fettle::robot
