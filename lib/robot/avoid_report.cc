#include "robot/avoid_report.h"

#include "cloud/fields.h"
#include "core/constants.h"
#include "robot/collision_report.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

namespace {

using json::Value;

// Azimuth of a tilt, degrees; NaN without a tilt.
double azimuth(const Eigen::Vector2d& tilt)
{
    return tilt.isZero(0) ? NAN : std::atan2(-tilt.x(), tilt.y()) / core::kRadPerDegree;
}

bool is_solved(const AvoidedPath& avoided, std::size_t i, double tolerance)
{
    const PoseState state = avoided.path.state[i];
    return state == PoseState::undefined ||
           (state == PoseState::reached && !(avoided.checked.at_poses[i].clearance < -tolerance));
}

Value pair_or_null(const Robot& robot, const std::vector<CellPair>& pairs, const CellClearance& c)
{
    return std::isnan(c.clearance) ? Value(NAN) : pair_to_json(robot, pairs[c.pair]);
}

} // namespace

Eigen::Matrix3Xd retreat_directions(const cloud::Cloud& cloud, const cloud::PosePath& poses)
{
    Eigen::Matrix3Xd directions(3, poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) directions.col(i) = poses[i].linear().col(2);
    const char* const names[] = {"normal_x", "normal_y", "normal_z"};
    if (!std::ranges::all_of(names, [&](const char* n) { return cloud::has_field(cloud, n); })) return directions;
    Eigen::Matrix3Xd normals(3, directions.cols());
    for (Eigen::Index k = 0; k < 3; ++k) normals.row(k) = cloud::field(cloud, names[k]);
    for (Eigen::Index i = 0; i < directions.cols(); ++i) {
        const double length = normals.col(i).norm();
        if (length > 0 && std::isfinite(length)) directions.col(i) = normals.col(i) / length;
    }
    return directions;
}

void set_changes(cloud::Cloud& cloud, const AvoidedPath& avoided, double tolerance)
{
    Eigen::MatrixXd columns(cloud.size(), 4);
    for (std::size_t i = 0; i < avoided.changes.size(); ++i) {
        const PoseChange& change = avoided.changes[i];
        const int kind = (change.tilt.isZero(0) ? 0 : 1) + (change.retreat == 0 ? 0 : 2);
        columns.row(i) << (is_solved(avoided, i, tolerance) ? kind : 4), change.tilt.norm() / core::kRadPerDegree,
            azimuth(change.tilt), change.retreat;
    }
    const char* const names[] = {"avoided", "tilt", "tilt_towards", "retreat"};
    for (Eigen::Index k = 0; k < 4; ++k) cloud::set_field(cloud, names[k], columns.col(k));
}

void add_report(Value& report, const Robot& robot, const AvoidedPath& avoided, const CheckedPath& before,
                const AvoidOptions& options, const CollisionOptions& collision, const units::Units& units)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    std::size_t tilted = 0, retreated = 0, colliding_motions = 0;
    double max_tilt = 0, max_retreat = 0, max_tilt_change = 0;
    std::vector<Value> changes, unsolved;
    for (std::size_t i = 0; i < avoided.changes.size(); ++i) {
        const PoseChange& change = avoided.changes[i];
        if (i > 0) max_tilt_change = std::max(max_tilt_change, tilt_between(avoided.changes[i - 1].tilt, change.tilt));
        if (avoided.checked.between_poses[i].clearance < -collision.tolerance) ++colliding_motions;
        const bool solved = is_solved(avoided, i, collision.tolerance);
        const CellClearance &was = before.at_poses[i], &is = avoided.checked.at_poses[i];
        if (!solved)
            unsolved.push_back(Value()
                                   .set("pose", i)
                                   .set("clearance", is.clearance / units.mm())
                                   .set("pair", pair_or_null(robot, pairs, is)));
        if (change == PoseChange()) continue;
        tilted += change.tilt.isZero(0) ? 0 : 1;
        retreated += change.retreat == 0 ? 0 : 1;
        max_tilt = std::max(max_tilt, change.tilt.norm());
        max_retreat = std::max(max_retreat, change.retreat);
        changes.push_back(Value()
                              .set("pose", i)
                              .set("tilt_deg", change.tilt.norm() / core::kRadPerDegree)
                              .set("towards_deg", azimuth(change.tilt))
                              .set("retreat", change.retreat / units.mm())
                              .set("clearance_before", was.clearance / units.mm())
                              .set("pair_before", pair_or_null(robot, pairs, was))
                              .set("clearance", is.clearance / units.mm()));
    }
    report.set("avoidance", Value()
                                .set("by", options.smooth ? "smooth" : "pose")
                                .set("changed", changes.size())
                                .set("tilted", tilted)
                                .set("drawn_back", retreated)
                                .set("unsolved", unsolved.size())
                                .set("unsolved_ways", colliding_motions)
                                .set("max_tilt_deg", max_tilt / core::kRadPerDegree)
                                .set("max_tilt_change_deg", max_tilt_change / core::kRadPerDegree)
                                .set("max_retreat", max_retreat / units.mm())
                                .set("changes", changes)
                                .set("unsolved_poses", unsolved));
}

} // namespace fettle::robot
