#include "sampling/probe.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "sampling/trend.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

namespace fettle {

Eigen::Matrix3Xd probe(const Scan& scan, const Job& job, const TouchPlan& plan, const TouchNoise& noise,
                       std::uint64_t seed)
{
    const double radius = job.probe.tip_radius;
    const Eigen::Matrix2Xd b = job.anomaly.topRows<2>();
    if (const double across = (b.rowwise().maxCoeff() - b.rowwise().minCoeff()).maxCoeff(); radius > across)
        throw InputError(job.source, "a probe's tip of radius " + to_short_text(radius / job.units.mm()) +
                                         " is larger than the anomaly, " + to_short_text(across / job.units.mm()) +
                                         " across");
    Eigen::Matrix3Xd touches(3, plan.size());
    touches.topRows<2>() = plan.xy;
    tbb::parallel_for(Eigen::Index{0}, plan.size(), [&](Eigen::Index i) {
        const Eigen::Vector2d xy = plan.xy.col(i);
        const std::optional<double> z = radius > 0 ? scan.drop_ball(xy, radius) : scan.height(xy);
        touches(2, i) = z.value_or(std::numeric_limits<double>::quiet_NaN());
    });
    touches.row(2) += draw_noise(noise, plan.size(), seed).transpose();
    if (radius == 0) return touches;
    touches.row(2).array() += radius;
    return contact_points(job, touches, radius);
}

void check_touched(const Eigen::Matrix3Xd& touches, const Job& job, const TouchPlan& plan, const std::string& source,
                   const std::string& doubt)
{
    constexpr int kNamed = 5; // too long a list helps nobody
    int missed = 0;
    std::string places;
    for (Eigen::Index i = 0; i < touches.cols(); ++i)
        if (std::isnan(touches(2, i)) && ++missed <= kNamed)
            places += (places.empty() ? "" : ", ") + place(plan.xy.col(i), job.units);
    if (missed == 0) return;
    if (missed > kNamed) places += " and " + std::to_string(missed - kNamed) + " more";
    throw InputError(source, std::to_string(missed) + " of " + std::to_string(touches.cols()) +
                                 " touches find no surface, at " + places + (doubt.empty() ? "" : "; " + doubt));
}

Cloud sample_cloud(const Eigen::Matrix3Xd& touches, const TouchPlan& plan, const std::vector<Eigen::Index>& order)
{
    Cloud samples;
    samples.xyz = touches(Eigen::all, order);
    set_field(samples, "curve", plan.curve(order).cast<double>());
    set_field(samples, "role", plan.role(order).cast<double>());
    return samples;
}

Eigen::Matrix3Xd contact_points(const Job& job, const Eigen::Matrix3Xd& centres, double radius)
{
    std::vector<Eigen::Index> touched;
    for (Eigen::Index i = 0; i < centres.cols(); ++i)
        if (!std::isnan(centres(2, i))) touched.push_back(i);
    Eigen::Matrix3Xd contacts = centres;
    if (touched.empty()) return contacts;
    const Trend trend(job, centres(Eigen::all, touched));
    for (const Eigen::Index i : touched) {
        const Eigen::Vector2d slope = trend.gradient(centres.col(i).head<2>());
        const Eigen::Vector3d normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
        contacts.col(i) -= radius * normal;
    }
    return contacts;
}

} // namespace fettle
