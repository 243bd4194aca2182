#include "sampling/probe.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"
#include "sampling/trend.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace fettle::sampling {

Eigen::Matrix3Xd probe(const Scan& scan, const job::Job& job, const TouchPlan& plan, const TouchNoise& noise,
                       std::uint64_t seed)
{
    const double radius = job.probe.tip_radius;
    if (const double across = geometry::bounding_box(job.anomaly.topRows<2>()).sizes().maxCoeff(); radius > across)
        throw core::InputError(job.source, "a probe's tip of radius " + core::to_short_text(radius / job.units.mm()) +
                                               " is larger than the anomaly, " +
                                               core::to_short_text(across / job.units.mm()) + " across");
    Eigen::Matrix3Xd touches(3, plan.size());
    touches.topRows<2>() = plan.xy;
    tbb::parallel_for(Eigen::Index{0}, plan.size(), [&](Eigen::Index i) {
        const Eigen::Vector2d xy = plan.xy.col(i);
        const std::optional<double> z = radius > 0 ? scan.drop_ball(xy, radius) : scan.height(xy);
        touches(2, i) = z.value_or(core::kNaN);
    });
    touches.row(2) += draw_noise(noise, plan.size(), seed).transpose();
    if (radius == 0) return touches;
    touches.row(2).array() += radius;
    return contact_points(job, touches, radius);
}

void check_all_touched(const Eigen::Matrix3Xd& touches, const job::Job& job, const TouchPlan& plan,
                       const std::string& source, const std::string& hint)
{
    constexpr int kMaxListed = 5; // bounds the length of the message
    int missed = 0;
    std::string places;
    for (Eigen::Index i = 0; i < touches.cols(); ++i)
        if (std::isnan(touches(2, i)) && ++missed <= kMaxListed)
            places += (places.empty() ? "" : ", ") + job::point_text(plan.xy.col(i), job.units);
    if (missed == 0) return;
    if (missed > kMaxListed) places += " and " + std::to_string(missed - kMaxListed) + " more";
    throw core::InputError(source, std::to_string(missed) + " of " + std::to_string(touches.cols()) +
                                       " touches find no surface, at " + places + (hint.empty() ? "" : "; " + hint));
}

cloud::Cloud sample_cloud(const Eigen::Matrix3Xd& touches, const TouchPlan& plan,
                          const std::vector<Eigen::Index>& order)
{
    cloud::Cloud samples;
    samples.xyz = touches(Eigen::all, order);
    cloud::set_field(samples, "curve", plan.curve(order).cast<double>());
    cloud::set_field(samples, "role", plan.role(order).cast<double>());
    return samples;
}

Eigen::Matrix3Xd contact_points(const job::Job& job, const Eigen::Matrix3Xd& centres, double radius)
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

} // namespace fettle::sampling
