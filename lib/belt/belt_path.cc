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
    if (!(point.pressing.amount > 0)) throw InputError(place + "the force or depth is not positive");
    if (!(point.feed > 0)) throw InputError(place + "the feed is not positive");
    if (!(point.dwell >= 0)) throw InputError(place + "the dwell is negative");
}

} // namespace

std::vector<BeltPoint> belt_path(const Cloud& path, const BeltSettings& settings)
{
    const auto values = [&](const char* name, double otherwise) -> Eigen::VectorXd {
        return has_field(path, name) ? field(path, name) : Eigen::VectorXd::Constant(path.size(), otherwise);
    };
    const bool by_depth = settings.depth || (!settings.force && has_field(path, "depth"));
    const std::optional<double> amount = by_depth ? settings.depth : settings.force;
    const char* const name = by_depth ? "depth" : "force";
    if (!amount && !has_field(path, name)) throw InputError("no field force or depth, and neither --force nor --depth");
    const Eigen::VectorXd amounts = amount ? Eigen::VectorXd::Constant(path.size(), *amount) : field(path, name);
    const Eigen::VectorXd feed = values("feed", settings.feed), dwell = values("dwell", 0), pass = values("pass", 0);
    const PosePath poses = path_poses(path);
    std::vector<BeltPoint> points;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        points.push_back({poses[k], {!by_depth, amounts[i]}, feed[i], dwell[i], false});
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
