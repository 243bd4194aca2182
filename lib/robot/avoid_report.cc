#include "robot/avoid_report.h"

#include "cloud/fields.h"
#include "core/constants.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using json::Value;

// NaN if it does not lean.
double azimuth(const Eigen::Vector2d& tilt)
{
    return tilt.isZero(0) ? NAN : std::atan2(-tilt.x(), tilt.y()) / kRadPerDegree;
}

bool is_solved(const AvoidedPath& avoided, std::size_t i, double tolerance)
{
    const PoseState state = avoided.path.state[i];
    return state == PoseState::undefined ||
           (state == PoseState::reached && !(avoided.checked.pose[i].clearance < -tolerance));
}

Value pair_to_json(const Robot& robot, const std::vector<CellPair>& pairs, const CellClearance& c)
{
    if (std::isnan(c.clearance)) return Value(NAN);
    return std::vector<Value>{body_name(robot, pairs[c.pair].a), body_name(robot, pairs[c.pair].b)};
}

} // namespace

Eigen::Matrix3Xd retreat_directions(const Cloud& cloud, const PosePath& poses)
{
    Eigen::Matrix3Xd away(3, static_cast<Eigen::Index>(poses.size()));
    for (std::size_t i = 0; i < poses.size(); ++i) away.col(static_cast<Eigen::Index>(i)) = poses[i].linear().col(2);
    const char* const names[] = {"normal_x", "normal_y", "normal_z"};
    if (!std::all_of(std::begin(names), std::end(names), [&](const char* n) { return has_field(cloud, n); }))
        return away;
    Eigen::Matrix3Xd normals(3, away.cols());
    for (Eigen::Index k = 0; k < 3; ++k) normals.row(k) = field(cloud, names[k]);
    for (Eigen::Index i = 0; i < away.cols(); ++i) {
        const double length = normals.col(i).norm();
        if (length > 0 && std::isfinite(length)) away.col(i) = normals.col(i) / length;
    }
    return away;
}

void set_changes(Cloud& cloud, const AvoidedPath& avoided, double tolerance)
{
    Eigen::MatrixXd columns(cloud.size(), 4);
    for (std::size_t i = 0; i < avoided.changes.size(); ++i) {
        const PoseChange& change = avoided.changes[i];
        const int what = (change.tilt.isZero(0) ? 0 : 1) + (change.retreat == 0 ? 0 : 2);
        columns.row(static_cast<Eigen::Index>(i)) << (is_solved(avoided, i, tolerance) ? what : 4),
            change.tilt.norm() / kRadPerDegree, azimuth(change.tilt), change.retreat;
    }
    const char* const names[] = {"avoided", "tilt", "tilt_towards", "retreat"};
    for (Eigen::Index k = 0; k < 4; ++k) set_field(cloud, names[k], columns.col(k));
}

void add_report(Value& report, const Robot& robot, const AvoidedPath& avoided, const CheckedPath& before,
                const AvoidOptions& options, const CollisionOptions& collision, const Units& units)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    std::size_t tilted = 0, drawn_back = 0, ways = 0;
    double most_tilt = 0, most_retreat = 0, most_change = 0;
    std::vector<Value> changes, unsolved;
    for (std::size_t i = 0; i < avoided.changes.size(); ++i) {
        const PoseChange& change = avoided.changes[i];
        if (i > 0) most_change = std::max(most_change, tilt_between(avoided.changes[i - 1].tilt, change.tilt));
        if (avoided.checked.between[i].clearance < -collision.tolerance) ++ways;
        const bool solved = is_solved(avoided, i, collision.tolerance);
        const CellClearance &was = before.pose[i], &is = avoided.checked.pose[i];
        if (!solved)
            unsolved.push_back(Value()
                                   .set("pose", i)
                                   .set("clearance", is.clearance / units.mm())
                                   .set("pair", pair_to_json(robot, pairs, is)));
        if (change == PoseChange()) continue;
        tilted += change.tilt.isZero(0) ? 0 : 1;
        drawn_back += change.retreat == 0 ? 0 : 1;
        most_tilt = std::max(most_tilt, change.tilt.norm());
        most_retreat = std::max(most_retreat, change.retreat);
        changes.push_back(Value()
                              .set("pose", i)
                              .set("tilt_deg", change.tilt.norm() / kRadPerDegree)
                              .set("towards_deg", azimuth(change.tilt))
                              .set("retreat", change.retreat / units.mm())
                              .set("clearance_before", was.clearance / units.mm())
                              .set("pair_before", pair_to_json(robot, pairs, was))
                              .set("clearance", is.clearance / units.mm()));
    }
    report.set("avoidance", Value()
                                .set("by", options.smooth ? "smooth" : "pose")
                                .set("changed", changes.size())
                                .set("tilted", tilted)
                                .set("drawn_back", drawn_back)
                                .set("unsolved", unsolved.size())
                                .set("unsolved_ways", ways)
                                .set("most_tilt_deg", most_tilt / kRadPerDegree)
                                .set("most_tilt_change_deg", most_change / kRadPerDegree)
                                .set("most_retreat", most_retreat / units.mm())
                                .set("changes", changes)
                                .set("unsolved_poses", unsolved));
}

} // namespace fettle
