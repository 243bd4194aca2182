#include "sampling/estimate.h"

#include "cloud/fields.h"
#include "core/constants.h"
#include "core/error.h"
#include "geometry/bounding_box.h"
#include "sampling/touch_plan.h"
#include "sampling/trend.h"

#include <cstring>
#include <map>

namespace fettle::sampling {

namespace {

// The four touches of one line, in W: coordinate t along the line, and z. `offset` is the line's other coordinate.
struct SampledLine {
    bool along_y = false;
    double offset = 0;
    Eigen::Vector4d t, z;
};

SampledLine sampled_line(const Eigen::Matrix3Xd& touches, const Trend& trend, double theta, int number)
{
    const std::string name = "curve " + std::to_string(number);
    if (touches.cols() != 4)
        throw core::InputError(name + ": " + std::to_string(touches.cols()) +
                               " touches near the boundaries, 4 are needed");
    SampledLine line;
    const Eigen::Vector3d extent = geometry::bounding_box(touches).sizes();
    line.along_y = extent.y() > extent.x();
    const int along = line.along_y ? 1 : 0, across = 1 - along;
    line.offset = touches.row(across).mean();
    line.t = touches.row(along);
    const Eigen::Matrix2d to_machine = job::rotation_working_machine(theta).transpose();
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d touched = touches.col(i).head<2>();
        Eigen::Vector2d on_line = touched;
        on_line[across] = line.offset;
        line.z[i] = touches(2, i) + trend.height(to_machine * on_line) - trend.height(to_machine * touched);
        for (int j = 0; j < i; ++j)
            if (line.t[i] == line.t[j]) throw core::InputError(name + ": two touches at the same place");
    }
    return line;
}

// Lagrange interpolation of the four touches at t.
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

// The bytes of a point's missing value: NaN in floating-point fields, 0 in integer fields.
std::vector<std::byte> missing_value(const cloud::Field& field)
{
    std::vector<std::byte> bytes(field.size * field.count);
    const float single_nan = core::kNaN;
    for (int k = 0; field.type == 'F' && k < field.count; ++k)
        std::memcpy(&bytes[k * field.size], field.size == 8 ? static_cast<const void*>(&core::kNaN) : &single_nan,
                    field.size);
    return bytes;
}

} // namespace

Eigen::Matrix3Xd estimated_points(const job::Job& job, const Eigen::Matrix3Xd& touches, const Eigen::VectorXi& curve,
                                  const Eigen::VectorXi& role)
{
    std::map<int, std::vector<Eigen::Index>> curves;
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < touches.cols(); ++i) {
        const bool near_boundary = role[i] == static_cast<int>(Role::near_anomaly) ||
                                   role[i] == static_cast<int>(Role::near_sampling_boundary);
        if (!near_boundary || curve[i] == kNoLine || !touches.col(i).allFinite()) continue;
        curves[curve[i]].push_back(i);
        used.push_back(i);
    }
    if (used.empty()) return Eigen::Matrix3Xd(3, 0);

    const Trend trend(job, touches(Eigen::all, used));
    Eigen::Matrix3Xd working = touches;
    working.topRows<2>() = job::rotation_working_machine(job.theta) * touches.topRows<2>();
    std::vector<SampledLine> along_y, along_x;
    for (const auto& [number, members] : curves) {
        const SampledLine line = sampled_line(working(Eigen::all, members), trend, job.theta, number);
        (line.along_y ? along_y : along_x).push_back(line);
    }
    Eigen::Matrix3Xd points(3, along_y.size() * along_x.size());
    Eigen::Index i = 0;
    for (const SampledLine& p : along_y)
        for (const SampledLine& q : along_x)
            points.col(i++) << p.offset, q.offset, (cubic(p, q.offset) + cubic(q, p.offset)) / 2;
    points.topRows<2>() = job::rotation_working_machine(job.theta).transpose() * points.topRows<2>();
    return points;
}

cloud::Cloud with_estimated_points(const job::Job& job, const cloud::Cloud& samples)
{
    const Eigen::VectorXi curve = cloud::integer_field(samples, "curve"), role = cloud::integer_field(samples, "role");
    if ((role.array() == static_cast<int>(Role::estimated)).any())
        throw core::InputError("already has estimated points (role 3)");
    if (job.surface != job::SurfaceType::freeform || (curve.array() == kNoLine).all()) return samples;

    const Eigen::Matrix3Xd estimated = estimated_points(job, samples.xyz, curve, role);
    if (estimated.cols() == 0) throw core::InputError("no touches of role 1 and 2, which a free-form job has");
    cloud::Cloud result = samples;
    result.width = 0;
    result.xyz.conservativeResize(3, samples.size() + estimated.cols());
    result.xyz.rightCols(estimated.cols()) = estimated;
    for (cloud::Field& extended : result.fields) {
        const std::vector<std::byte> missing = missing_value(extended);
        for (Eigen::Index i = 0; i < estimated.cols(); ++i)
            extended.bytes.insert(extended.bytes.end(), missing.begin(), missing.end());
    }
    Eigen::VectorXd roles = cloud::field(result, "role");
    roles.tail(estimated.cols()).setConstant(static_cast<double>(Role::estimated));
    cloud::set_field(result, "role", roles);
    return result;
}

} // namespace fettle::sampling
