#include "robot/collision_report.h"

#include "core/error.h"
#include "core/text.h"
#include "robot/solve_path.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fettle::robot {

namespace {

using json::Value;

Value minimum_to_json(const Robot& robot, const std::vector<CellClearance>& list,
                      const std::optional<Eigen::VectorXd>& times, double mm)
{
    Value value;
    const Eigen::Index at = min_clearance_index(list);
    if (at < 0) return value;
    const CellClearance& c = list[at];
    const std::vector<CellPair> pairs = checked_pairs(robot);
    value.set("clearance", c.clearance / mm).set("pose", at);
    if (times) value.set("time", (*times)[at]);
    if (c.pair < pairs.size() && std::isfinite(c.clearance))
        value.set("pair", pair_to_json(robot, pairs[c.pair])).set("point", Eigen::VectorXd(c.point / mm));
    return value;
}

} // namespace

Eigen::Index min_clearance_index(const std::vector<CellClearance>& list)
{
    Eigen::Index min = -1;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (!std::isnan(list[i].clearance) && (min < 0 || list[i].clearance < list[min].clearance)) min = i;
    return min;
}

Value pair_to_json(const Robot& robot, const CellPair& pair)
{
    return std::vector<Value>{body_name(robot, pair.a), body_name(robot, pair.b)};
}

void set_clearances(cloud::Cloud& cloud, const Robot& robot, const CheckedPath& checked)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    const Eigen::Index count = cloud.size();
    Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(count, 7, NAN);
    for (Eigen::Index i = 0; i < count; ++i) {
        const CellClearance& c = checked.at_poses[i];
        columns(i, 0) = c.clearance;
        columns(i, 1) = checked.between_poses[i].clearance;
        if (!std::isfinite(c.clearance)) continue;
        columns.row(i).tail<5>() << double(pairs[c.pair].a), double(pairs[c.pair].b), c.point.transpose();
    }
    const char* const names[] = {"clearance", "clearance_between", "body", "other", "foot_x", "foot_y", "foot_z"};
    for (Eigen::Index k = 0; k < 7; ++k) cloud::set_field(cloud, names[k], columns.col(k));
}

bool add_report(Value& report, const Robot& robot, const CheckedPath& checked, const CollisionOptions& options,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units)
{
    const double mm = units.mm();
    struct PairCollisions {
        double min_clearance; // mm
        std::size_t poses;
    };
    std::map<std::size_t, PairCollisions> by_pair;
    std::size_t poses = 0, motions = 0, measured = 0;
    for (std::size_t i = 0; i < checked.at_poses.size(); ++i) {
        const CellClearance& c = checked.at_poses[i];
        if (!std::isnan(c.clearance)) ++measured;
        if (checked.between_poses[i].clearance < -options.tolerance) ++motions;
        if (!(c.clearance < -options.tolerance)) continue;
        ++poses;
        PairCollisions& pair = by_pair.try_emplace(c.pair, PairCollisions{c.clearance, 0}).first->second;
        pair.min_clearance = std::min(pair.min_clearance, c.clearance);
        ++pair.poses;
    }
    const std::vector<CellPair> pairs = checked_pairs(robot);
    std::vector<Value> colliding;
    for (const auto& [pair, collisions] : by_pair)
        colliding.push_back(Value()
                                .set("pair", pair_to_json(robot, pairs[pair]))
                                .set("poses", collisions.poses)
                                .set("min_clearance", collisions.min_clearance / mm));
    report.set("checked", measured)
        .set("collisions", poses)
        .set("collisions_between", motions)
        .set("midpoints_checked", checked.midpoint_count)
        .set("tolerance", options.tolerance / mm)
        .set("max_missed_depth", (options.tolerance + options.resolution / 2) / mm)
        .set("min", minimum_to_json(robot, checked.at_poses, times, mm))
        .set("min_between", minimum_to_json(robot, checked.between_poses, times, mm))
        .set("colliding", colliding);
    if (options.model != nullptr)
        report.set("grids", options.model->grid_count())
            .set("cell", options.model->cell_size() / mm)
            .set("cuboids_too_near", options.model->accuracy() / mm);
    return poses == 0 && motions == 0;
}

std::vector<std::size_t> parse_pose_indices(const std::string& text, const CheckedPath& checked)
{
    if (text.empty()) {
        const Eigen::Index nearest = min_clearance_index(checked.at_poses);
        if (nearest < 0) throw core::InputError("--picture", "no pose is reached");
        return {static_cast<std::size_t>(nearest)};
    }
    std::vector<std::size_t> poses;
    for (const double number : core::parse_number_list(text)) {
        if (!(number >= 0 && number < 1e9 && number == std::floor(number)))
            throw core::InputError("--at", "expected whole numbers with commas between, got '" + text + "'");
        poses.push_back(static_cast<std::size_t>(number));
    }
    return poses;
}

} // namespace fettle::robot
