#include "belt/path_report.h"

#include "cloud/poses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::belt {

cloud::Cloud to_cloud(const ContactPath& path)
{
    cloud::Cloud cloud;
    const Eigen::Index size = path.poses.size();
    cloud.xyz.resize(3, size);
    cloud.comment = "frame: part";
    cloud::set_poses(cloud, path.poses);
    const Eigen::VectorXd pass = Eigen::VectorXi::Map(path.pass.data(), size).cast<double>();
    cloud::set_field(cloud, "pass", pass);
    cloud::set_field(cloud, "stroke", pass);
    return cloud;
}

json::Value report_path(const cloud::Cloud& path)
{
    const cloud::PosePath poses = cloud::read_poses(path);
    Eigen::VectorXd pass = Eigen::VectorXd::Zero(path.size());
    if (cloud::has_field(path, "pass")) pass = cloud::field(path, "pass");
    double length = 0, length_between = 0, longest = 0, turn = 0;
    std::size_t passes = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (pass[i] >= 0 && (i == 0 || pass[i] != pass[i - 1])) ++passes;
        if (i == 0) continue;
        const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
        if (!std::isfinite(step)) continue;
        const bool is_off_part = pass[i] < 0 || pass[i - 1] < 0; // the tool moves off the part
        if (is_off_part) length_between += step;
        if (is_off_part || pass[i] != pass[i - 1]) continue;
        length += step;
        longest = std::max(longest, step);
        turn = std::max(
            turn, Eigen::Quaterniond(poses[i].linear()).angularDistance(Eigen::Quaterniond(poses[i - 1].linear())));
    }
    return json::Value()
        .set("points", poses.size())
        .set("passes", passes)
        .set("length", length)
        .set("length_between", length_between)
        .set("longest_step", longest)
        .set("largest_turn_deg", turn * 180 / std::numbers::pi);
}

} // namespace fettle::belt
