#include "belt/belt_path.h"

#include "cloud/poses.h"
#include "core/error.h"

#include <cmath>
#include <limits>
#include <string>

namespace fettle {

namespace {

void check(const BeltPoint& point, std::size_t k)
{
    const std::string place = "point " + std::to_string(k) + ": ";
    if (std::isnan(point.pressing.amount)) throw InputError(place + "neither force nor depth is given");
    if (!(point.pressing.amount > 0)) throw InputError(place + "the force or depth is not positive");
    if (!(point.feed > 0)) throw InputError(place + "the feed is not positive");
    if (!(point.dwell >= 0)) throw InputError(place + "the dwell is negative");
}

} // namespace

std::vector<BeltPoint> belt_path(const Cloud& path, const BeltSettings& settings)
{
    const auto constant = [&](double value) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(path.size(), value);
    };
    const auto values = [&](const char* name, double otherwise) {
        return has_field(path, name) ? field(path, name) : constant(otherwise);
    };
    const bool is_told = settings.depth || settings.force;
    if (!is_told && !has_field(path, "depth") && !has_field(path, "force"))
        throw InputError("no field force or depth, and neither --force nor --depth");
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const Eigen::VectorXd depth = is_told ? constant(settings.depth.value_or(kNone)) : values("depth", kNone);
    const Eigen::VectorXd force = is_told ? constant(settings.force.value_or(kNone)) : values("force", kNone);
    const Eigen::VectorXd feed = values("feed", settings.feed), dwell = values("dwell", 0), pass = values("pass", 0);
    const PosePath poses = path_poses(path);
    std::vector<BeltPoint> points;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const bool by_force = std::isnan(depth[i]);
        points.push_back({poses[k], {by_force, by_force ? force[i] : depth[i]}, feed[i], dwell[i], false});
        if (!poses[k].translation().allFinite())
            points[k].T_part_tool.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
        else
            check(points[k], k);
        points[k].begins_run = k == 0 || !points[k - 1].is_on() || pass[i] != pass[i - 1];
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        const bool ends = k + 1 == points.size() || !points[k + 1].is_on() || points[k + 1].begins_run;
        if (points[k].is_on() && (points[k].begins_run || ends)) points[k].dwell += settings.dwell;
    }
    return points;
}

Eigen::VectorXd ways(const std::vector<BeltPoint>& path)
{
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(path.size()));
    for (std::size_t k = 1; k < path.size(); ++k) {
        if (path[k].begins_run || !path[k].is_on() || !path[k - 1].is_on()) continue;
        const double way = (path[k].T_part_tool.translation() - path[k - 1].T_part_tool.translation()).norm();
        const auto i = static_cast<Eigen::Index>(k);
        result[i - 1] += way / 2;
        result[i] += way / 2;
    }
    return result;
}

} // namespace fettle
