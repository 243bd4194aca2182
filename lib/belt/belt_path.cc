#include "belt/belt_path.h"

#include "cloud/poses.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace fettle::belt {

namespace {

void check(const BeltPoint& point, std::size_t k)
{
    const std::string label = "point " + std::to_string(k) + ": ";
    if (std::isnan(point.load.value)) throw core::InputError(label + "neither force nor depth is given");
    if (!(point.load.value > 0)) throw core::InputError(label + "the force or depth is not positive");
    if (!(point.feed > 0)) throw core::InputError(label + "the feed is not positive");
    if (!(point.dwell >= 0)) throw core::InputError(label + "the dwell is negative");
}

} // namespace

std::vector<BeltPoint> belt_path(const cloud::Cloud& path, const BeltSettings& settings)
{
    const auto constant = [&](double value) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(path.size(), value);
    };
    const auto values = [&](const char* name, double fallback) {
        return cloud::has_field(path, name) ? cloud::field(path, name) : constant(fallback);
    };
    const bool has_setting = settings.depth || settings.force;
    if (!has_setting && !cloud::has_field(path, "depth") && !cloud::has_field(path, "force"))
        throw core::InputError("no field force or depth, and neither --force nor --depth");
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::VectorXd depth = has_setting ? constant(settings.depth.value_or(kNan)) : values("depth", kNan);
    const Eigen::VectorXd force = has_setting ? constant(settings.force.value_or(kNan)) : values("force", kNan);
    const Eigen::VectorXd feed = values("feed", settings.feed), dwell = values("dwell", 0), pass = values("pass", 0);
    const cloud::PosePath poses = cloud::read_poses(path);
    const Eigen::VectorXd stroke = cloud::read_strokes(path);
    std::vector<BeltPoint> points;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const bool by_force = std::isnan(depth[k]);
        points.push_back({poses[k], {by_force, by_force ? force[k] : depth[k]}, feed[k], dwell[k], false});
        if (!poses[k].translation().allFinite() || stroke[k] < 0)
            points[k].T_part_tool.matrix().setConstant(kNan);
        else
            check(points[k], k);
        points[k].touches_down = k == 0 || !points[k - 1].is_on_part() || pass[k] != pass[k - 1];
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        const bool ends_run = k + 1 == points.size() || !points[k + 1].is_on_part() || points[k + 1].touches_down;
        if (points[k].is_on_part() && (points[k].touches_down || ends_run)) points[k].dwell += settings.dwell;
    }
    return points;
}

Eigen::VectorXd tributary_lengths(const std::vector<BeltPoint>& path)
{
    Eigen::VectorXd result = Eigen::VectorXd::Zero(path.size());
    for (std::size_t k = 1; k < path.size(); ++k) {
        if (path[k].touches_down || !path[k].is_on_part() || !path[k - 1].is_on_part()) continue;
        const double length = (path[k].T_part_tool.translation() - path[k - 1].T_part_tool.translation()).norm();
        result[k - 1] += length / 2;
        result[k] += length / 2;
    }
    return result;
}

std::size_t end_of_pass(const std::vector<BeltPoint>& path, std::size_t point)
{
    const auto next = std::find_if(path.begin() + std::ptrdiff_t(point) + 1, path.end(),
                                   [](const BeltPoint& at) { return at.touches_down; });
    return std::size_t(next - path.begin());
}

} // namespace fettle::belt
