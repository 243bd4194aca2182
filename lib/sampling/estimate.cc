#include "sampling/estimate.h"

#include "cloud/fields.h"
#include "core/error.h"
#include "sampling/touch_plan.h"
#include "sampling/trend.h"

#include <cmath>
#include <limits>
#include <map>

namespace fettle {

namespace {

// Touches of one line, in W: t along it, z; the line lies at `offset` across.
struct SampledLine {
    bool along_y = false;
    double offset = 0;
    Eigen::Vector4d t, z;
};

SampledLine sampled_line(const Eigen::Matrix3Xd& working, const Trend& trend, double theta, int number)
{
    const std::string name = "curve " + std::to_string(number);
    if (working.cols() != 4)
        throw InputError(name + ": " + std::to_string(working.cols()) + " touches near the boundaries, 4 are needed");
    SampledLine line;
    const Eigen::Vector3d extent = working.rowwise().maxCoeff() - working.rowwise().minCoeff();
    line.along_y = extent.y() > extent.x();
    const int along = line.along_y ? 1 : 0, across = 1 - along;
    line.offset = working.row(across).mean();
    line.t = working.row(along);
    const Eigen::Matrix2d to_machine = rotation_working_machine(theta).transpose();
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d touched = working.col(i).head<2>();
        Eigen::Vector2d on_line = touched;
        on_line[across] = line.offset;
        line.z[i] = working(2, i) + trend.height(to_machine * on_line) - trend.height(to_machine * touched);
        for (int j = 0; j < i; ++j)
            if (line.t[i] == line.t[j]) throw InputError(name + ": two touches at the same place");
    }
    return line;
}

// The cubic through the four touches (Lagrange), at t.
double cubic(const SampledLine& line, double t)
{
    double z = 0;
    for (int i = 0; i < 4; ++i) {
        double weight = 1;
        for (int j = 0; j < 4; ++j)
            if (j != i) weight *= (t - line.t[j]) / (line.t[i] - line.t[j]);
        z += weight * line.z[i];
    }
    return z;
}

// What an appended point has in a field that says nothing of it.
std::vector<std::byte> no_value(const Field& field)
{
    std::vector<std::byte> bytes(static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count));
    const float single = std::numeric_limits<float>::quiet_NaN();
    const double twice = std::numeric_limits<double>::quiet_NaN();
    const std::byte* nan = reinterpret_cast<const std::byte*>(&single);
    if (field.size == 8) nan = reinterpret_cast<const std::byte*>(&twice);
    if (field.type == 'F')
        for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = nan[k % static_cast<std::size_t>(field.size)];
    return bytes;
}

} // namespace

Eigen::Matrix3Xd estimated_points(const Job& job, const Eigen::Matrix3Xd& touches, const Eigen::VectorXi& curve,
                                  const Eigen::VectorXi& role)
{
    std::map<int, std::vector<Eigen::Index>> curves;
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < touches.cols(); ++i) {
        const bool near = role[i] == static_cast<int>(Role::near_anomaly) ||
                          role[i] == static_cast<int>(Role::near_sampling_boundary);
        if (!near || !touches.col(i).allFinite()) continue;
        curves[curve[i]].push_back(i);
        used.push_back(i);
    }
    if (used.empty()) return Eigen::Matrix3Xd(3, 0);

    const Trend trend(job, touches(Eigen::all, used));
    Eigen::Matrix3Xd working = touches;
    working.topRows<2>() = rotation_working_machine(job.theta) * touches.topRows<2>();
    std::vector<SampledLine> along_y, along_x;
    for (const auto& [number, members] : curves) {
        const SampledLine line = sampled_line(working(Eigen::all, members), trend, job.theta, number);
        (line.along_y ? along_y : along_x).push_back(line);
    }
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(along_y.size() * along_x.size()));
    Eigen::Index i = 0;
    for (const SampledLine& p : along_y)
        for (const SampledLine& q : along_x)
            points.col(i++) << p.offset, q.offset, (cubic(p, q.offset) + cubic(q, p.offset)) / 2;
    points.topRows<2>() = rotation_working_machine(job.theta).transpose() * points.topRows<2>();
    return points;
}

Cloud with_estimated_points(const Job& job, const Cloud& samples)
{
    const Eigen::VectorXi curve = whole_numbers(samples, "curve"), role = whole_numbers(samples, "role");
    if ((role.array() == static_cast<int>(Role::estimated)).any())
        throw InputError("holds estimated points already (role 3)");
    if (job.surface != SurfaceType::freeform || (curve.array() == kNoLine).all()) return samples;

    const Eigen::Matrix3Xd estimated = estimated_points(job, samples.xyz, curve, role);
    if (estimated.cols() == 0) throw InputError("no touches of role 1 and 2, which a free-form job has");
    Cloud result = samples;
    result.width = 0;
    result.xyz.conservativeResize(3, samples.size() + estimated.cols());
    result.xyz.rightCols(estimated.cols()) = estimated;
    for (Field& extended : result.fields) {
        const std::vector<std::byte> missing = no_value(extended);
        for (Eigen::Index i = 0; i < estimated.cols(); ++i)
            extended.bytes.insert(extended.bytes.end(), missing.begin(), missing.end());
    }
    Eigen::VectorXd roles = field(result, "role");
    roles.tail(estimated.cols()).setConstant(static_cast<double>(Role::estimated));
    set_field(result, "role", roles);
    return result;
}

} // namespace fettle
