#include "robot/collision_report.h"

#include <cmath>
#include <map>
#include <string>

namespace fettle {

namespace {

using json::Value;

std::vector<Value> names_of(const Robot& robot, const CellPair& pair)
{
    return {body_name(robot, pair.a), body_name(robot, pair.b)};
}

Value least_to_json(const Robot& robot, const std::vector<CellClearance>& list,
                    const std::optional<Eigen::VectorXd>& times, double mm)
{
    Value value;
    const Eigen::Index at = least_of(list);
    if (at < 0) return value;
    const CellClearance& c = list[static_cast<std::size_t>(at)];
    const std::vector<CellPair> pairs = checked_pairs(robot);
    value.set("clearance", c.clearance / mm).set("pose", static_cast<std::size_t>(at));
    if (times) value.set("time", (*times)[at]);
    if (c.pair < pairs.size() && std::isfinite(c.clearance))
        value.set("pair", names_of(robot, pairs[c.pair])).set("point", Eigen::VectorXd(c.point / mm));
    return value;
}

} // namespace

Eigen::Index least_of(const std::vector<CellClearance>& list)
{
    Eigen::Index least = -1;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (!std::isnan(list[i].clearance) &&
            (least < 0 || list[i].clearance < list[static_cast<std::size_t>(least)].clearance))
            least = static_cast<Eigen::Index>(i);
    return least;
}

void set_clearances(Cloud& cloud, const Robot& robot, const CheckedPath& checked)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    const Eigen::Index count = cloud.size();
    Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(count, 7, NAN);
    for (Eigen::Index i = 0; i < count; ++i) {
        const CellClearance& c = checked.pose[static_cast<std::size_t>(i)];
        columns(i, 0) = c.clearance;
        columns(i, 1) = checked.between[static_cast<std::size_t>(i)].clearance;
        if (!std::isfinite(c.clearance)) continue;
        columns.row(i).tail<5>() << static_cast<double>(pairs[c.pair].a), static_cast<double>(pairs[c.pair].b),
            c.point.transpose();
    }
    const char* const names[] = {"clearance", "clearance_between", "body", "other", "foot_x", "foot_y", "foot_z"};
    for (Eigen::Index k = 0; k < 7; ++k) set_field(cloud, names[k], columns.col(k));
}

bool add_report(Value& report, const Robot& robot, const CheckedPath& checked, const CollisionOptions& options,
                const std::optional<Eigen::VectorXd>& times, const Units& units)
{
    const double mm = units.mm();
    std::size_t poses = 0, ways = 0, looked_at = 0;
    std::map<std::size_t, CellClearance> worst; // by pair
    std::map<std::size_t, std::size_t> times_worst;
    for (std::size_t i = 0; i < checked.pose.size(); ++i) {
        const CellClearance& c = checked.pose[i];
        if (!std::isnan(c.clearance)) ++looked_at;
        if (checked.between[i].clearance < -options.tolerance) ++ways;
        if (!(c.clearance < -options.tolerance)) continue;
        ++poses;
        ++times_worst[c.pair];
        const auto [found, added] = worst.emplace(c.pair, c);
        if (!added && c.clearance < found->second.clearance) found->second = c;
    }
    const std::vector<CellPair> pairs = checked_pairs(robot);
    std::vector<Value> colliding;
    for (const auto& [pair, c] : worst)
        colliding.push_back(Value()
                                .set("pair", names_of(robot, pairs[pair]))
                                .set("poses", times_worst[pair])
                                .set("least_clearance", c.clearance / mm));
    report.set("looked_at", looked_at)
        .set("collisions", poses)
        .set("collisions_between", ways)
        .set("looks_between", checked.looks)
        .set("tolerance", options.tolerance / mm)
        .set("not_missed", (options.tolerance + options.resolution / 2) / mm)
        .set("least", least_to_json(robot, checked.pose, times, mm))
        .set("least_between", least_to_json(robot, checked.between, times, mm))
        .set("colliding", colliding);
    if (options.model != nullptr)
        report.set("grids", options.model->grids())
            .set("cell", options.model->cell() / mm)
            .set("cuboids_too_near", options.model->accuracy() / mm);
    return poses == 0 && ways == 0;
}

} // namespace fettle
