#include "robot/externals.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/arm.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle {

namespace {

constexpr double kPi = std::numbers::pi;
// Rules are weighed by so many poses of the path: each costs an inverse for every rule.
constexpr std::size_t kPosesWeighed = 64;
// Places along the track: 50 mm on the paper's 2 m. Angles of the table: 15 degrees.
constexpr int kPlaces = 41, kAngles = 24;
// A tip nearer to the table's axis has no azimuth worth following, mm.
constexpr double kOnAxis = 1e-6;

bool is_pose(const Eigen::Isometry3d& T) { return !T.translation().hasNaN(); }

std::vector<double> spread(double least, double most, int count)
{
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(least + (most - least) * i / (count - 1));
    return values;
}

// Rules for one axis, those that stand before those that follow.
std::vector<AxisRule> candidates(const std::optional<AxisRule>& wanted, const std::vector<double>& stand,
                                 const std::vector<double>& follow)
{
    if (wanted) return {*wanted};
    std::vector<AxisRule> rules;
    for (const double value : stand) rules.push_back({false, value});
    for (const double value : follow) rules.push_back({true, value});
    return rules;
}

std::vector<AxisRule> track_rules(const Robot& robot, const ExternalRules& wanted)
{
    if (!robot.track) return {AxisRule{}};
    const JointRange& range = robot.track->range;
    const double reach = robot.dh[0].a + std::abs(robot.dh[1].a) + std::hypot(robot.dh[2].a, robot.dh[3].d);
    return candidates(wanted.track, spread(range.least, range.most, kPlaces), spread(-reach, reach, kPlaces));
}

std::vector<AxisRule> table_rules(const Robot& robot, const ExternalRules& wanted)
{
    if (!robot.table) return {AxisRule{}};
    const JointRange& range = robot.table->range;
    const double most = std::min(range.most, range.least + 2 * kPi);
    return candidates(wanted.table, spread(range.least, most, kAngles + 1), spread(-kPi, kPi, kAngles + 1));
}

PosePath some_of(const PosePath& poses)
{
    PosePath some;
    for (std::size_t i = 0; i < kPosesWeighed; ++i) {
        const std::size_t k = poses.size() <= kPosesWeighed ? i : i * (poses.size() - 1) / (kPosesWeighed - 1);
        if (k < poses.size() && is_pose(poses[k])) some.push_back(poses[k]);
    }
    return some;
}

ExternalChoice weigh(const Robot& robot, const Arm& arm, const PosePath& poses, const AxisRule& track,
                     const AxisRule& table)
{
    ExternalChoice choice = {track, table, 0, INFINITY};
    const Eigen::Matrix2Xd values = external_values(robot, poses, track, table);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        double best = -1;
        for (const ArmSolution& solution :
             arm.solve(flange_for(robot, poses[i], values(0, k), values(1, k)), Joints::Zero(), Ranges::respect))
            best = std::max(best, arm.singularity(solution.joints).least());
        if (best < 0)
            ++choice.unreached;
        else
            choice.singularity = std::min(choice.singularity, best);
    }
    return choice;
}

bool better(const ExternalChoice& a, const ExternalChoice& b)
{
    if (a.unreached != b.unreached) return a.unreached < b.unreached;
    const int following_a = int(a.track.follows) + int(a.table.follows);
    const int following_b = int(b.track.follows) + int(b.table.follows);
    if (following_a != following_b) return following_a < following_b;
    return a.singularity > b.singularity;
}

double track_value(const Track& track, const AxisRule& rule, const Eigen::Vector3d& base, const Eigen::Vector3d& tip)
{
    if (!rule.follows) return rule.value;
    return std::clamp((tip - base).dot(track.axis) - rule.value, track.range.least, track.range.most);
}

// The turn nearest to `before` that brings the tip to the wanted azimuth, within the range if one is.
double table_value(const Table& table, const AxisRule& rule, const Eigen::Vector3d& tip, double before)
{
    if (!rule.follows) return rule.value;
    const bool along_x = std::abs(table.axis.x()) > 1 - 1e-9;
    const Eigen::Vector3d reference = along_x ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d x = (reference - reference.dot(table.axis) * table.axis).normalized();
    const Eigen::Vector3d y = table.axis.cross(x), r = tip - table.point;
    if (std::hypot(x.dot(r), y.dot(r)) < kOnAxis) return before;
    const double turn = rule.value - std::atan2(y.dot(r), x.dot(r));
    double nearest = before + std::remainder(turn - before, 2 * kPi);
    if (nearest > table.range.most) nearest -= 2 * kPi * std::ceil((nearest - table.range.most) / (2 * kPi));
    if (nearest < table.range.least) nearest += 2 * kPi * std::ceil((table.range.least - nearest) / (2 * kPi));
    return nearest;
}

} // namespace

std::optional<AxisRule> parse_axis_rule(const std::string& text, double unit)
{
    if (text == "auto") return std::nullopt;
    const std::string follow = "follow:";
    const bool follows = text.starts_with(follow);
    const std::optional<double> number = parse_number(follows ? text.substr(follow.size()) : text);
    if (!number || !std::isfinite(*number))
        throw InputError("expected auto, a number or follow:NUMBER, got " + in_quotes(text));
    return AxisRule{follows, *number * unit};
}

Eigen::Isometry3d cell_base(const Robot& robot, double track)
{
    Eigen::Isometry3d T = robot.T_cell_base;
    if (robot.track) T.translation() += track * robot.track->axis;
    return T;
}

Eigen::Isometry3d cell_part(const Robot& robot, double table)
{
    if (!robot.table) return Eigen::Isometry3d::Identity();
    const Eigen::Translation3d to(robot.table->point);
    return to * Eigen::AngleAxisd(table, robot.table->axis) * to.inverse();
}

Eigen::Isometry3d flange_for(const Robot& robot, const Eigen::Isometry3d& T_part_tool, double track, double table)
{
    return cell_base(robot, track).inverse() * cell_part(robot, table) * T_part_tool * robot.T_flange_tool.inverse();
}

Eigen::Matrix2Xd external_values(const Robot& robot, const PosePath& poses, const AxisRule& track,
                                 const AxisRule& table)
{
    Eigen::Matrix2Xd values(2, static_cast<Eigen::Index>(poses.size()));
    double before = robot.table ? std::clamp(0.0, robot.table->range.least, robot.table->range.most) : 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        Eigen::Vector2d value(NAN, NAN);
        if (is_pose(poses[i])) {
            const Eigen::Vector3d tip = poses[i].translation();
            value[1] = before = robot.table ? table_value(*robot.table, table, tip, before) : 0;
            const Eigen::Vector3d in_cell = cell_part(robot, value[1]) * tip;
            value[0] = robot.track ? track_value(*robot.track, track, robot.T_cell_base.translation(), in_cell) : 0;
        }
        values.col(static_cast<Eigen::Index>(i)) = value;
    }
    return values;
}

ExternalChoice choose_externals(const Robot& robot, const PosePath& poses, const ExternalRules& wanted)
{
    const Arm arm(robot);
    const PosePath some = some_of(poses);
    const std::vector<AxisRule> tracks = track_rules(robot, wanted), tables = table_rules(robot, wanted);
    std::vector<ExternalChoice> choices(tracks.size() * tables.size());
    tbb::parallel_for(std::size_t{0}, choices.size(), [&](std::size_t i) {
        choices[i] = weigh(robot, arm, some, tracks[i / tables.size()], tables[i % tables.size()]);
    });
    return *std::min_element(choices.begin(), choices.end(), &better);
}

} // namespace fettle
