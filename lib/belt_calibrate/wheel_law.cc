#include "belt_calibrate/wheel_law.h"

#include "core/error.h"

#include <cmath>

namespace fettle::belt_calibrate {

belt::BeltLaw belt_law(const calibrate::LearntLaw& law, const belt::ContactWheel& wheel, double area, double travel)
{
    constexpr double kSecondsPerMinute = 60;
    const removal::RemovalTrial& reference = law.belief.reference();
    if (std::isnan(reference.duration)) throw core::InputError("--wheel", "needs trials at rest, with grind_time_s");
    const calibrate::Parameters mean = law.belief.posterior().mean;
    const bool has_speed = calibrate::is_recorded(reference, calibrate::speed);
    const double reference_speed = has_speed ? reference.speed * travel / kSecondsPerMinute : wheel.belt_speed;
    belt::BeltLaw result;
    result.pressure_exponent = mean[calibrate::force];
    result.speed_exponent = mean[calibrate::speed];
    result.dwell_exponent = mean[calibrate::duration];
    result.coefficient =
        std::exp(mean[calibrate::level]) / area * std::pow(area / reference.force, mean[calibrate::force]) *
        std::pow(reference_speed, -mean[calibrate::speed]) * std::pow(reference.duration, -mean[calibrate::duration]);
    if (mean[calibrate::wear] > 0)
        result.wear_work = law.belief.pass_work() / mean[calibrate::wear] * travel / kSecondsPerMinute;
    return result;
}

json::Value to_json(const BeltRunLaw& law)
{
    std::vector<json::Value> parameters;
    for (Eigen::Index k = 0; k < law.mean.size(); ++k)
        parameters.push_back(json::Value()
                                 .set("name", law.names[k])
                                 .set("mean", law.mean[k])
                                 .set("sigma", std::sqrt(law.covariance(k, k))));
    return json::Value()
        .set("parameters", parameters)
        .set("covariance", law.covariance)
        .set("reference_pressure", law.reference_pressure)
        .set("reference_feed", law.reference_feed)
        .set("depth_error", law.depth_error)
        .set("surfels", law.surfels);
}

} // namespace fettle::belt_calibrate
