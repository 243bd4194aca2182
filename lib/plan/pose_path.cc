#include "plan/pose_path.h"

#include "cloud/poses.h"

#include <algorithm>

namespace fettle::plan {

namespace {

struct Builder {
    const Plan& plan;
    Eigen::Isometry3d T_part_job;
    Eigen::Matrix3d R_job_tool; ///< +x along the passes, +z up
    cloud::PosePath poses;
    std::vector<Eigen::Vector3d> normals;
    std::vector<double> layer, stroke;

    void add(const Eigen::Vector3d& point, int in_layer, double in_stroke)
    {
        Eigen::Isometry3d T_job_tool = Eigen::Isometry3d::Identity();
        T_job_tool.linear() = R_job_tool;
        T_job_tool.translation() = point + reference_offset(plan.layers, in_layer) * Eigen::Vector3d::UnitZ();
        poses.push_back(T_part_job * T_job_tool);
        normals.push_back(T_part_job.linear() * surface::normal(plan.surface, point.head<2>()));
        layer.push_back(in_layer);
        stroke.push_back(in_stroke);
    }
};

/// One contact interval of a pass: its points, from first to before end.
struct Stretch {
    int pass, first, end;
};

std::vector<Stretch> stretches_of(const ToolPath& path)
{
    std::vector<Stretch> stretches;
    for (std::size_t p = 0; p < path.passes().size(); ++p) {
        const ToolPass& pass = path.passes()[p];
        for (std::size_t k = 0; k < pass.starts.size(); ++k)
            stretches.push_back(
                {static_cast<int>(p), pass.starts[k],
                 k + 1 < pass.starts.size() ? pass.starts[k + 1] : static_cast<int>(pass.points.size())});
    }
    return stretches;
}

} // namespace

cloud::Cloud pose_path(const Plan& plan, const ToolPath& path, int layers)
{
    const Eigen::Matrix2d axes = pass_axes(plan.job); // columns: across, along
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R.col(0).head<2>() = axes.col(1);
    R.col(1) = Eigen::Vector3d::UnitZ().cross(R.col(0));
    Builder builder{plan, plan.job.T_part_job.value_or(Eigen::Isometry3d::Identity()), R, {}, {}, {}, {}};
    const std::vector<Stretch> stretches = stretches_of(path);
    double stroke = 0;
    for (int layer = layers; layer >= 1; --layer)
        for (const Stretch& stretch : stretches) {
            const auto& points = path.passes()[stretch.pass].points;
            for (int i = stretch.first; i < stretch.end; ++i) // zig-zag: every other pass runs back
                builder.add(points[stretch.pass % 2 == 0 ? i : stretch.first + stretch.end - 1 - i], layer, stroke);
            ++stroke;
        }
    cloud::Cloud cloud;
    const auto count = static_cast<Eigen::Index>(builder.poses.size());
    cloud.xyz.resize(3, count);
    cloud.comment = "frame: part";
    cloud::set_poses(cloud, builder.poses);
    Eigen::Matrix3Xd normals(3, count);
    for (Eigen::Index i = 0; i < count; ++i) normals.col(i) = builder.normals[i];
    cloud::set_normals(cloud, normals);
    const auto set = [&](const char* name, const std::vector<double>& values) {
        cloud::set_field(cloud, name, Eigen::VectorXd::Map(values.data(), count));
    };
    const auto set_constant = [&](const char* name, double value) {
        cloud::set_field(cloud, name, Eigen::VectorXd::Constant(count, value));
    };
    set("layer", builder.layer);
    set("pass", builder.stroke);
    set("stroke", builder.stroke);
    set_constant("feed", plan.job.feed.rate);
    set_constant("force", plan.job.force.down);
    set_constant("force_min", plan.job.force.min);
    set_constant("force_max", plan.job.force.max);
    return cloud;
}

} // namespace fettle::plan
