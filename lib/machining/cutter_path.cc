#include "machining/cutter_path.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/tilt.h"

#include <Eigen/Geometry>

#include <cmath>

namespace fettle::machining {
namespace {

/// Requires that every pose turns +z into the axis: a height field has only one. The points are in the tilted frame,
/// the axis and what is said of the poses in M.
void require_axis(const cloud::Cloud& points, const Eigen::Vector3d& axis, const std::string& source)
{
    const auto has = [&](const char* name) { return cloud::has_field(points, name); };
    if (!has("qw") && !has("qx") && !has("qy") && !has("qz")) return;
    static constexpr double kFloatRounding = 1e-6;
    const Eigen::VectorXd w = cloud::field(points, "qw"), x = cloud::field(points, "qx"),
                          y = cloud::field(points, "qy"), z = cloud::field(points, "qz");
    const Eigen::Matrix3d rotation = rotation_tilted_machine(axis);
    for (Eigen::Index i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d found =
            rotation.transpose() * (Eigen::Quaterniond(w[i], x[i], y[i], z[i]).normalized() * Eigen::Vector3d::UnitZ());
        const auto text = [](const Eigen::Vector3d& v) {
            const Eigen::Vector3d shown = (v.array().abs() < kFloatRounding).select(0, v);
            return core::to_short_text(shown.x()) + ", " + core::to_short_text(shown.y()) + ", " +
                   core::to_short_text(shown.z());
        };
        if (!((found - axis).norm() <= kFloatRounding))
            throw core::InputError(source, "point " + std::to_string(i + 1) + ": the cutter's axis is " + text(found) +
                                               ", expected " + text(axis));
    }
}

Eigen::Matrix3Xd tips_at_contacts(const cloud::Cloud& points, const Cutter& cutter, const std::string& source)
{
    if (!cloud::has_normals(points))
        throw core::InputError(source, "contact points need normal_x, normal_y and normal_z");
    const Eigen::Matrix3Xd directions = cloud::normals(points);
    Eigen::Matrix3Xd tips(3, points.size());
    for (Eigen::Index i = 0; i < points.size(); ++i) try {
            const double norm = directions.col(i).norm();
            if (!(norm > 0 && std::isfinite(norm))) throw core::InputError("its normal has no direction");
            tips.col(i) = tip_at_contact(cutter, points.xyz.col(i), directions.col(i) / norm);
        } catch (const core::InputError& error) {
            throw core::InputError(source, "point " + std::to_string(i + 1) + ": " + error.what());
        }
    return tips;
}

} // namespace

double length(const CutterMove& move)
{
    if (move.sweep_angle == 0) return (move.to - move.from).norm();
    return std::abs(move.sweep_angle) * (move.from.head<2>() - move.centre).norm();
}

std::vector<CutterMove> moves_from_points(const cloud::Cloud& points, const Cutter& cutter, bool contacts, double feed,
                                          const std::string& source, const Eigen::Vector3d& axis)
{
    require_axis(points, axis, source);
    const Eigen::Matrix3Xd tips = contacts ? tips_at_contacts(points, cutter, source) : points.xyz;
    Eigen::VectorXd feeds = Eigen::VectorXd::Constant(points.size(), feed);
    if (cloud::has_field(points, "feed")) feeds = cloud::field(points, "feed");
    std::vector<CutterMove> moves;
    for (Eigen::Index i = 0; i < tips.cols(); ++i) {
        const std::string place = "point " + std::to_string(i + 1);
        if (!tips.col(i).allFinite()) throw core::InputError(source, place + ": not a finite position");
        if (!(feeds[i] >= 0 && std::isfinite(feeds[i])))
            throw core::InputError(source, place + ": feed must be at least 0, got " + core::to_text(feeds[i]));
        if (i == 0) continue;
        moves.push_back({.from = tips.col(i - 1), .to = tips.col(i), .feed = feeds[i]});
        moves.back().source_line = i + 1;
    }
    if (moves.empty()) throw core::InputError(source, "a path needs two points or more");
    return moves;
}

} // namespace fettle::machining
