#include "robot/follow.h"

#include "core/constants.h"
#include "robot/arm.h"
#include "robot/layered_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// One way to reach a pose.
struct Station {
    Joints joints;
    int branch;
};

// All whole turns of the joints that stay in range, joint by joint from the first.
void add_turns(const Robot& robot, const ArmSolution& solution, Eigen::Index joint, std::vector<Station>& stations)
{
    if (joint == 6) {
        stations.push_back({solution.joints, solution.branch});
        return;
    }
    const JointRange& range = robot.dh[static_cast<std::size_t>(joint)].range;
    ArmSolution turned = solution;
    double& q = turned.joints[joint];
    while (within(range, q - kTurn)) q -= kTurn;
    for (; within(range, q); q += kTurn) add_turns(robot, turned, joint + 1, stations);
}

class PathSearch {
  public:
    PathSearch(const Robot& robot, const FollowOptions& options) : robot_(robot), options_(options) {}

    /// @return  is there a way to this pose?
    bool add(const ArmSolutions& solutions, bool gap)
    {
        std::vector<Station> here;
        for (const ArmSolution& solution : solutions) add_turns(robot_, solution, 0, here);
        if (here.empty()) return false;
        search_.add(here.size(), [&](std::size_t from, std::size_t to) -> LayeredSearch::Length {
            if (layers_.empty()) return {0, (here[to].joints - options_.start).squaredNorm()};
            const Joints move = here[to].joints - layers_.back()[from].joints;
            return {!gap && move.cwiseAbs().maxCoeff() > options_.jump ? 1 : 0, move.squaredNorm()};
        });
        layers_.push_back(std::move(here));
        return true;
    }

    /// Joints of the best way so far.
    const Joints& near() const { return layers_.empty() ? options_.start : layers_.back()[search_.best()].joints; }

    /// Of each pose that was added.
    std::vector<Station> path() const
    {
        std::vector<Station> way;
        for (const std::size_t number : search_.path()) way.push_back(layers_[way.size()][number]);
        return way;
    }

  private:
    const Robot& robot_;
    const FollowOptions& options_;
    LayeredSearch search_;
    std::vector<std::vector<Station>> layers_; // of the poses that have any
};

// The joint that is farthest out of its range in the solution that is least far out.
Eigen::Index blocking_joint(const Robot& robot, const Arm& arm, const Eigen::Isometry3d& flange)
{
    double least = std::numeric_limits<double>::infinity();
    Eigen::Index joint = 0;
    for (const ArmSolution& solution : arm.solve(flange, Joints::Zero(), Ranges::ignore)) {
        Joints beyond;
        for (Eigen::Index k = 0; k < 6; ++k) {
            const JointRange& range = robot.dh[static_cast<std::size_t>(k)].range;
            beyond[k] = std::max(range.least - solution.joints[k], solution.joints[k] - range.most);
        }
        Eigen::Index worst = 0;
        const double most = beyond.maxCoeff(&worst);
        if (most < least) {
            least = most;
            joint = worst;
        }
    }
    return joint;
}

// Track (6) or table (7) where it is out of its range, else -1.
Eigen::Index external_out_of_range(const Robot& robot, const Eigen::Vector2d& external)
{
    if (robot.track && !within(robot.track->range, external[0])) return 6;
    if (robot.table && !within(robot.table->range, external[1])) return 7;
    return -1;
}

FollowedPath no_path(Eigen::Index count)
{
    FollowedPath path;
    path.joints = CellJointsPath::Constant(8, count, kNaN);
    path.state.assign(static_cast<std::size_t>(count), PoseState::undefined);
    path.branch.assign(static_cast<std::size_t>(count), -1);
    path.singularity = Eigen::VectorXd::Constant(count, kNaN);
    path.blocked.setZero();
    return path;
}

// Of all that turns: a table that follows the tip may have to turn back at an end of its range.
std::vector<Eigen::Index> jumps_of(const CellJointsPath& joints, double jump)
{
    std::vector<Eigen::Index> jumps;
    for (Eigen::Index i = 1; i < joints.cols(); ++i) {
        CellJoints turn = (joints.col(i) - joints.col(i - 1)).cwiseAbs();
        turn[6] *= 0; // mm; still NaN where there is no pose
        if (turn.maxCoeff<Eigen::PropagateNaN>() > jump) jumps.push_back(i);
    }
    return jumps;
}

} // namespace

std::vector<std::pair<int, Joints>> all_solutions(const Robot& robot, const Eigen::Isometry3d& T_base_flange)
{
    std::vector<Station> stations;
    for (const ArmSolution& solution : Arm(robot).solve(T_base_flange, Joints::Zero(), Ranges::respect))
        add_turns(robot, solution, 0, stations);
    std::vector<std::pair<int, Joints>> all;
    for (const Station& station : stations) all.emplace_back(station.branch, station.joints);
    return all;
}

FollowedPath follow(const Robot& robot, const PosePath& poses, const Eigen::Matrix2Xd& externals,
                    const FollowOptions& options)
{
    const Arm arm(robot);
    const auto count = static_cast<Eigen::Index>(poses.size());
    FollowedPath path = no_path(count);
    PathSearch search(robot, options);
    Eigen::Index last = -1; // pose reached before
    for (Eigen::Index i = 0; i < count; ++i) {
        PoseState& state = path.state[static_cast<std::size_t>(i)];
        const Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(i)];
        if (pose.translation().hasNaN()) continue;
        const Eigen::Isometry3d flange = flange_for(robot, pose, externals(0, i), externals(1, i));
        const Eigen::Index external = external_out_of_range(robot, externals.col(i));
        const ArmSolutions solutions = arm.solve(flange, search.near(), Ranges::respect);
        if (external < 0 && search.add(solutions, last != i - 1)) {
            state = PoseState::reached;
            last = i;
        } else if (external >= 0 || solutions.reachable) {
            state = PoseState::out_of_range;
            ++path.blocked[external >= 0 ? external : blocking_joint(robot, arm, flange)];
        } else {
            state = PoseState::unreachable;
        }
    }
    const std::vector<Station> way = search.path();
    std::size_t reached = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        if (path.state[static_cast<std::size_t>(i)] != PoseState::reached) continue;
        const Station& station = way[reached++];
        path.joints.col(i) << station.joints, externals.col(i);
        path.branch[static_cast<std::size_t>(i)] = station.branch;
        path.singularity[i] = arm.singularity(station.joints).least();
    }
    path.jumps = jumps_of(path.joints, options.jump);
    return path;
}

FollowedPath judge(const Robot& robot, const CellJointsPath& joints, double jump)
{
    const Arm arm(robot);
    FollowedPath path = no_path(joints.cols());
    path.joints = joints;
    for (Eigen::Index i = 0; i < joints.cols(); ++i) {
        const CellJoints q = joints.col(i);
        if (q.hasNaN()) continue;
        Eigen::Index blocked = external_out_of_range(robot, q.tail<2>());
        for (Eigen::Index k = 5; k >= 0; --k)
            if (!within(robot.dh[static_cast<std::size_t>(k)].range, q[k])) blocked = k;
        if (blocked >= 0) ++path.blocked[blocked];
        path.state[static_cast<std::size_t>(i)] = blocked >= 0 ? PoseState::out_of_range : PoseState::reached;
        path.singularity[i] = arm.singularity(q.head<6>()).least();
    }
    path.jumps = jumps_of(joints, jump);
    return path;
}

} // namespace fettle
