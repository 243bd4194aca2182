#include "machining/cutter_path.h"

#include "core/error.h"
#include "core/text.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fettle {
namespace {

/// The map of heights is looked at along one axis: every pose must turn +z into it.
void require_axis(const Cloud& points, const Eigen::Vector3d& axis, const std::string& source)
{
    const char* const kParts[] = {"qw", "qx", "qy", "qz"};
    if (std::none_of(std::begin(kParts), std::end(kParts), [&](const char* part) { return has_field(points, part); }))
        return;
    constexpr double kSame = 1e-6; // rounding of floats
    const Eigen::VectorXd w = field(points, "qw"), x = field(points, "qx"), y = field(points, "qy"),
                          z = field(points, "qz");
    for (Eigen::Index i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d of = Eigen::Quaterniond(w[i], x[i], y[i], z[i]).normalized() * Eigen::Vector3d::UnitZ();
        if (!((of - axis).norm() <= kSame))
            throw InputError(source, "point " + std::to_string(i + 1) + ": the cutter's axis is " +
                                         to_short_text(of.x()) + ", " + to_short_text(of.y()) + ", " +
                                         to_short_text(of.z()) + ", expected " + to_short_text(axis.x()) + ", " +
                                         to_short_text(axis.y()) + ", " + to_short_text(axis.z()));
    }
}

Eigen::Matrix3Xd tips_at(const Cloud& points, const Cutter& cutter, const std::string& source)
{
    if (!has_normals(points)) throw InputError(source, "contact points need normal_x, normal_y and normal_z");
    const Eigen::Matrix3Xd directions = normals(points);
    Eigen::Matrix3Xd tips(3, points.size());
    for (Eigen::Index i = 0; i < points.size(); ++i) try {
            const double size = directions.col(i).norm();
            if (!(size > 0 && std::isfinite(size))) throw InputError("its normal has no direction");
            tips.col(i) = tip_at_contact(cutter, points.xyz.col(i), directions.col(i) / size);
        } catch (const InputError& error) {
            throw InputError(source, "point " + std::to_string(i + 1) + ": " + error.what());
        }
    return tips;
}

} // namespace

double length(const CutterMove& move)
{
    if (move.sweep == 0) return (move.to - move.from).norm();
    return std::abs(move.sweep) * (move.from.head<2>() - move.centre).norm();
}

std::vector<CutterMove> moves_through(const Cloud& points, const Cutter& cutter, bool contacts, double feed,
                                      const std::string& source, const Eigen::Vector3d& axis)
{
    require_axis(points, axis, source);
    const Eigen::Matrix3Xd tips = contacts ? tips_at(points, cutter, source) : points.xyz;
    Eigen::VectorXd feeds = Eigen::VectorXd::Constant(points.size(), feed);
    if (has_field(points, "feed")) feeds = field(points, "feed");
    std::vector<CutterMove> moves;
    for (Eigen::Index i = 0; i < tips.cols(); ++i) {
        const std::string place = "point " + std::to_string(i + 1);
        if (!tips.col(i).allFinite()) throw InputError(source, place + ": not a finite position");
        if (!(feeds[i] >= 0 && std::isfinite(feeds[i])))
            throw InputError(source, place + ": feed must be at least 0, got " + to_text(feeds[i]));
        if (i == 0) continue;
        CutterMove move;
        move.from = tips.col(i - 1);
        move.to = tips.col(i);
        move.feed = feeds[i];
        move.place = static_cast<std::size_t>(i + 1);
        moves.push_back(move);
    }
    if (moves.empty()) throw InputError(source, "a path needs two points or more");
    return moves;
}

} // namespace fettle
