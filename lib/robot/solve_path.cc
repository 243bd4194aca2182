#include "robot/solve_path.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/path_cloud.h"

#include <cmath>
#include <sstream>
#include <vector>

namespace fettle {

namespace {

Joints start_in(const std::string& text)
{
    const Eigen::VectorXd degrees = numbers_in(text);
    if (degrees.size() != 6 || !(degrees.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMostJointDegrees))
        throw InputError("--start", "expected six angles in degrees, up to " + to_short_text(kMostJointDegrees) +
                                        " either way, with commas between, got " + in_quotes(text));
    return degrees * kRadPerDegree;
}

std::optional<AxisRule> rule_in(const std::string& option, const std::string& text, bool exists, double unit)
{
    try {
        if (text != "auto" && !exists) throw InputError("the robot has none");
        return parse_axis_rule(text, unit);
    } catch (const InputError& error) {
        throw InputError(option, error.what());
    }
}

void check_not_empty(const Cloud& cloud)
{
    if (cloud.size() == 0) throw InputError("needs at least 1 point, got 0");
}

} // namespace

Eigen::VectorXd numbers_in(const std::string& text)
{
    std::istringstream parts(text);
    std::vector<double> numbers;
    for (std::string part; std::getline(parts, part, ',');) numbers.push_back(parse_number(part).value_or(NAN));
    return Eigen::Map<Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

SolvedPath solve_path(const Robot& robot, const Cloud& cloud, const PathWishes& wishes, double mm)
{
    const ExternalRules wanted = {rule_in("--track", wishes.track, robot.track.has_value(), mm),
                                  rule_in("--table", wishes.table, robot.table.has_value(), kRadPerDegree)};
    const FollowOptions options = {start_in(wishes.start), wishes.jump_deg * kRadPerDegree};
    check_not_empty(cloud);
    SolvedPath solved;
    solved.poses = path_poses(cloud);
    solved.externals = choose_externals(robot, solved.poses, wanted);
    solved.external_values = external_values(robot, solved.poses, solved.externals.track, solved.externals.table);
    solved.path = follow(robot, solved.poses, solved.external_values, options);
    return solved;
}

SolvedPath given_path(const Robot& robot, const Cloud& cloud, double jump_deg)
{
    check_not_empty(cloud);
    SolvedPath given;
    given.path = judge(robot, path_joints(cloud, robot), jump_deg * kRadPerDegree);
    given.poses = forward(robot, given.path.joints);
    given.external_values = given.path.joints.bottomRows<2>();
    return given;
}

} // namespace fettle
