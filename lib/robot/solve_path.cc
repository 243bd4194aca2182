#include "robot/solve_path.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/path_cloud.h"

#include <vector>

namespace fettle::robot {

namespace {

Joints parse_start(const std::string& text)
{
    const Eigen::VectorXd degrees = core::parse_number_list(text);
    if (degrees.size() != 6 || !(degrees.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMaxJointDegrees))
        throw core::InputError("--start", "expected six angles in degrees, up to " +
                                              core::to_short_text(kMaxJointDegrees) +
                                              " either way, with commas between, got " + core::in_quotes(text));
    return degrees * core::kRadPerDegree;
}

std::optional<AxisRule> parse_rule(const std::string& option, const std::string& text, bool exists, double unit)
{
    try {
        if (text != "auto" && !exists) throw core::InputError("the robot has none");
        return parse_axis_rule(text, unit);
    } catch (const core::InputError& error) {
        throw core::InputError(option, error.what());
    }
}

void check_not_empty(const cloud::Cloud& cloud)
{
    if (cloud.size() == 0) throw core::InputError("needs at least 1 point, got 0");
}

} // namespace

void check_arguments(const Robot& robot, const PathArguments& arguments, double mm)
{
    parse_rule("--track", arguments.track, robot.track.has_value(), mm);
    parse_rule("--table", arguments.table, robot.table.has_value(), core::kRadPerDegree);
    parse_start(arguments.start);
}

SolvedPath path_from_poses(const Robot& robot, const cloud::Cloud& cloud, const PathArguments& options, double mm,
                           const IsClear& is_clear)
{
    const ExternalRules rules = {parse_rule("--track", options.track, robot.track.has_value(), mm),
                                 parse_rule("--table", options.table, robot.table.has_value(), core::kRadPerDegree)};
    const FollowOptions follow_options = {parse_start(options.start), options.jump_threshold_deg * core::kRadPerDegree};
    check_not_empty(cloud);
    SolvedPath solved;
    solved.poses = cloud::read_poses(cloud);
    solved.externals = choose_externals(robot, solved.poses, rules, is_clear);
    solved.external_values = external_values(robot, solved.poses, solved.externals.track, solved.externals.table);
    solved.path = follow_path(robot, solved.poses, solved.external_values, follow_options);
    return solved;
}

SolvedPath path_from_joints(const Robot& robot, const cloud::Cloud& cloud, double jump_deg)
{
    check_not_empty(cloud);
    SolvedPath given;
    given.path = evaluate_joints(robot, path_joints(cloud, robot), jump_deg * core::kRadPerDegree);
    given.poses = forward_kinematics(robot, given.path.joints);
    given.external_values = given.path.joints.bottomRows<2>();
    return given;
}

SolvedPath solve_path(const Robot& robot, const cloud::Cloud& cloud, const PathArguments& options, double mm,
                      const IsClear& is_clear)
{
    if (cloud::has_field(cloud, "joint1")) return path_from_joints(robot, cloud, options.jump_threshold_deg);
    return path_from_poses(robot, cloud, options, mm, is_clear);
}

cloud::Cloud all_solutions(const Robot& robot, const cloud::Cloud& cloud, const SolvedPath& solved)
{
    std::vector<Eigen::Index> pose;
    std::vector<double> branches;
    std::vector<CellJoints> solutions;
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        const Eigen::Isometry3d& T_part_tool = solved.poses[i];
        if (T_part_tool.translation().hasNaN()) continue;
        const Eigen::Vector2d external = solved.external_values.col(i);
        for (const auto& [branch, joints] :
             all_solutions(robot, flange_target(robot, T_part_tool, external[0], external[1]))) {
            pose.push_back(i);
            branches.push_back(branch);
            solutions.emplace_back() << joints, external;
        }
    }
    cloud::Cloud all = cloud::select_points(cloud, pose);
    const auto count = static_cast<Eigen::Index>(pose.size());
    CellJointsPath joints(8, count);
    for (Eigen::Index i = 0; i < count; ++i) joints.col(i) = solutions[i];
    set_joints(all, robot, joints);
    cloud::set_field(all, "pose", Eigen::VectorX<Eigen::Index>::Map(pose.data(), count).cast<double>());
    cloud::set_field(all, "branch", Eigen::VectorXd::Map(branches.data(), count));
    return all;
}

} // namespace fettle::robot
