#include "robot/externals.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/arm.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace fettle::robot {

namespace {

constexpr double kPi = std::numbers::pi;
// Number of poses that rules are evaluated on: each needs the inverse kinematics for every rule.
constexpr std::size_t kMaxPosesEvaluated = 64;
// Positions of the track: 50 mm apart on the paper's 2 m. Angles of the table: 15 degrees apart.
constexpr int kTrackPositions = 41, kTableAngles = 24;
// Choices whose collisions are counted: the best by reach, spread over most of track and table. A second or two.
constexpr std::size_t kMaxChoicesChecked = 512, kChoicesAtATime = 16;
// The azimuth of a tip nearer to the table's axis is undetermined, mm.
constexpr double kMinAzimuthRadius = 1e-6;

bool is_pose(const Eigen::Isometry3d& T) { return !T.translation().hasNaN(); }

// Rules for one axis at values evenly spaced over two intervals: first those that stay, then those that follow.
std::vector<AxisRule> candidates(const std::optional<AxisRule>& given, const JointRange& stay, const JointRange& follow,
                                 int count)
{
    if (given) return {*given};
    std::vector<AxisRule> rules;
    for (const bool follows : {false, true}) {
        const auto& [min, max] = follows ? follow : stay;
        for (int i = 0; i < count; ++i) rules.push_back({follows, min + (max - min) * i / (count - 1)});
    }
    return rules;
}

std::vector<AxisRule> track_rules(const Robot& robot, const ExternalRules& given)
{
    if (!robot.track) return {AxisRule{}};
    const double reach = robot.dh[0].a + std::abs(robot.dh[1].a) + std::hypot(robot.dh[2].a, robot.dh[3].d);
    return candidates(given.track, robot.track->range, {-reach, reach}, kTrackPositions);
}

std::vector<AxisRule> table_rules(const Robot& robot, const ExternalRules& given)
{
    if (!robot.table) return {AxisRule{}};
    JointRange turn = robot.table->range;
    turn.max = std::min(turn.max, turn.min + 2 * kPi);
    return candidates(given.table, turn, {-kPi, kPi}, kTableAngles + 1);
}

cloud::PosePath sample_poses(const cloud::PosePath& poses)
{
    cloud::PosePath sample;
    for (std::size_t i = 0; i < kMaxPosesEvaluated; ++i) {
        const std::size_t k =
            poses.size() <= kMaxPosesEvaluated ? i : i * (poses.size() - 1) / (kMaxPosesEvaluated - 1);
        if (k < poses.size() && is_pose(poses[k])) sample.push_back(poses[k]);
    }
    return sample;
}

// Number of poses all of whose solutions collide, counted up to `limit`.
Eigen::Index count_colliding(const Robot& robot, const Arm& arm, const cloud::PosePath& poses,
                             const ExternalChoice& choice, const IsClear& is_clear, Eigen::Index limit)
{
    const Eigen::Matrix2Xd values = external_values(robot, poses, choice.track, choice.table);
    Eigen::Index colliding = 0;
    for (std::size_t i = 0; i < poses.size() && colliding < limit; ++i) {
        const ArmSolutions solutions =
            arm.solve(flange_target(robot, poses[i], values(0, i), values(1, i)), Joints::Zero(), Ranges::respect);
        const bool none_clear = std::ranges::none_of(solutions, [&](const ArmSolution& solution) {
            return is_clear((CellJoints() << solution.joints, values.col(i)).finished());
        });
        if (none_clear && solutions.size() > 0) ++colliding;
    }
    return colliding;
}

ExternalChoice evaluate_rules(const Robot& robot, const Arm& arm, const cloud::PosePath& poses, const AxisRule& track,
                              const AxisRule& table)
{
    ExternalChoice choice = {track, table, 0, 0, INFINITY};
    const Eigen::Matrix2Xd values = external_values(robot, poses, track, table);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        double best = -1;
        for (const ArmSolution& solution :
             arm.solve(flange_target(robot, poses[i], values(0, i), values(1, i)), Joints::Zero(), Ranges::respect))
            best = std::max(best, arm.singularity(solution.joints).min());
        if (best < 0)
            ++choice.unreached;
        else
            choice.singularity = std::min(choice.singularity, best);
    }
    return choice;
}

bool is_better(const ExternalChoice& a, const ExternalChoice& b)
{
    if (a.unreached != b.unreached) return a.unreached < b.unreached;
    const int following_a = a.track.follows + a.table.follows, following_b = b.track.follows + b.table.follows;
    if (following_a != following_b) return following_a < following_b;
    return a.singularity > b.singularity;
}

double track_value(const Track& track, const AxisRule& rule, const Eigen::Vector3d& base, const Eigen::Vector3d& tip)
{
    if (!rule.follows) return rule.value;
    return std::clamp((tip - base).dot(track.axis) - rule.value, track.range.min, track.range.max);
}

// The table's angle nearest to the previous one that brings the tip to the azimuth of the rule; shifted by whole turns
// towards the range if it is out of it.
double table_value(const Table& table, const AxisRule& rule, const Eigen::Vector3d& tip, double previous)
{
    if (!rule.follows) return rule.value;
    const bool along_x = std::abs(table.axis.x()) > 1 - 1e-9;
    const Eigen::Vector3d reference = along_x ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d x = (reference - reference.dot(table.axis) * table.axis).normalized();
    const Eigen::Vector3d y = table.axis.cross(x), r = tip - table.point;
    if (std::hypot(x.dot(r), y.dot(r)) < kMinAzimuthRadius) return previous;
    const double turn = rule.value - std::atan2(y.dot(r), x.dot(r));
    double nearest = previous + std::remainder(turn - previous, 2 * kPi);
    if (nearest > table.range.max) nearest -= 2 * kPi * std::ceil((nearest - table.range.max) / (2 * kPi));
    if (nearest < table.range.min) nearest += 2 * kPi * std::ceil((table.range.min - nearest) / (2 * kPi));
    return nearest;
}

} // namespace

std::optional<AxisRule> parse_axis_rule(const std::string& text, double unit)
{
    if (text == "auto") return std::nullopt;
    const std::string follow = "follow:";
    const bool follows = text.starts_with(follow);
    const std::optional<double> number = core::parse_number(follows ? text.substr(follow.size()) : text);
    if (!number || !std::isfinite(*number))
        throw core::InputError("expected auto, a number or follow:NUMBER, got " + core::in_quotes(text));
    return AxisRule{follows, *number * unit};
}

Eigen::Isometry3d base_in_cell(const Robot& robot, double track)
{
    Eigen::Isometry3d T = robot.T_cell_base;
    if (robot.track) T.translation() += track * robot.track->axis;
    return T;
}

Eigen::Isometry3d part_in_cell(const Robot& robot, double table)
{
    if (!robot.table) return Eigen::Isometry3d::Identity();
    const Eigen::Translation3d to(robot.table->point);
    return to * Eigen::AngleAxisd(table, robot.table->axis) * to.inverse();
}

Eigen::Isometry3d flange_target(const Robot& robot, const Eigen::Isometry3d& T_part_tool, double track, double table)
{
    return base_in_cell(robot, track).inverse() * part_in_cell(robot, table) * T_part_tool *
           robot.T_flange_tool.inverse();
}

Eigen::Matrix2Xd external_values(const Robot& robot, const cloud::PosePath& poses, const AxisRule& track,
                                 const AxisRule& table)
{
    Eigen::Matrix2Xd values(2, poses.size());
    double previous = robot.table ? std::clamp(0.0, robot.table->range.min, robot.table->range.max) : 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        Eigen::Vector2d value(NAN, NAN);
        if (is_pose(poses[i])) {
            const Eigen::Vector3d tip = poses[i].translation();
            value[1] = previous = robot.table ? table_value(*robot.table, table, tip, previous) : 0;
            const Eigen::Vector3d tip_in_cell = part_in_cell(robot, value[1]) * tip;
            value[0] = robot.track ? track_value(*robot.track, track, robot.T_cell_base.translation(), tip_in_cell) : 0;
        }
        values.col(i) = value;
    }
    return values;
}

// The first of the choices, best first, with the fewest colliding poses. Only those that reach as many poses as the
// first count; they are checked some at a time, until one is clear.
ExternalChoice fewest_collisions(const Robot& robot, const Arm& arm, const cloud::PosePath& poses,
                                 std::span<ExternalChoice> choices, const IsClear& is_clear)
{
    const auto reaches = [&](const ExternalChoice& c) { return c.unreached == choices.front().unreached; };
    const std::size_t count =
        std::min<std::size_t>(kMaxChoicesChecked, std::ranges::find_if_not(choices, reaches) - choices.begin());
    Eigen::Index fewest = std::numeric_limits<Eigen::Index>::max();
    const ExternalChoice* best = nullptr;
    for (std::size_t first = 0; first < count && fewest > 0; first += kChoicesAtATime) {
        const std::span<ExternalChoice> some = choices.subspan(first, std::min(kChoicesAtATime, count - first));
        tbb::parallel_for(std::size_t{0}, some.size(), [&](std::size_t i) {
            some[i].colliding = count_colliding(robot, arm, poses, some[i], is_clear, fewest);
        });
        for (const ExternalChoice& choice : some)
            if (choice.colliding < fewest) {
                fewest = choice.colliding;
                best = &choice;
            }
    }
    return *best;
}

ExternalChoice choose_externals(const Robot& robot, const cloud::PosePath& poses, const ExternalRules& rules,
                                const IsClear& is_clear)
{
    const Arm arm(robot);
    const cloud::PosePath sample = sample_poses(poses);
    const std::vector<AxisRule> tracks = track_rules(robot, rules), tables = table_rules(robot, rules);
    std::vector<ExternalChoice> choices(tracks.size() * tables.size());
    tbb::parallel_for(std::size_t{0}, choices.size(), [&](std::size_t i) {
        choices[i] = evaluate_rules(robot, arm, sample, tracks[i / tables.size()], tables[i % tables.size()]);
    });
    std::ranges::stable_sort(choices, &is_better);
    return is_clear && choices.size() > 1 ? fewest_collisions(robot, arm, sample, choices, is_clear) : choices.front();
}

} // namespace fettle::robot
