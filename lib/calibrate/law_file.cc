#include "calibrate/law_file.h"

#include "core/error.h"
#include "core/file.h"
#include "units/units.h"
#include "json/units.h"

#include <cmath>

namespace fettle::calibrate {

json::Value law_file(const json::Value& learnt)
{
    return json::Value().set("kind", "law").set("units", json::to_json(units::Units{})).set("learnt", learnt);
}

LawRecord read_law(const std::string& path)
{
    json::Reader reader = json::Reader::open(path);
    const std::string kind = reader.choice("kind", {"law", "wheel"});
    if (!reader.has("learnt")) reader.refuse("learnt", "is missing: the law was not learnt");
    json::Reader learnt = reader.object("learnt");
    return read_record(learnt.object("record"));
}

LawRecord continued(LawRecord record, const LawRecord& more, const std::string& source)
{
    for (const belt::RemovalTrial& pass : more.passes) {
        for (const Factor& factor : kFactors)
            if (std::isnan(pass.*factor.value) != std::isnan(record.passes.front().*factor.value))
                throw core::InputError(source, std::string("records other conditions than the known law: ") +
                                                   kParameterNames[factor.parameter]);
        record.passes.push_back(rebased(pass, more.base, record.base));
    }
    return record;
}

belt::BeltLaw belt_law(const LearntLaw& law, const belt::ContactWheel& wheel, double area, double travel)
{
    constexpr double kSecondsPerMinute = 60;
    const belt::RemovalTrial& reference = law.belief.reference();
    if (std::isnan(reference.duration)) throw core::InputError("--wheel", "needs trials at rest, with grind_time_s");
    const Parameters mean = law.belief.posterior().mean;
    const bool has_speed = is_recorded(reference, speed);
    const double reference_speed = has_speed ? reference.speed * travel / kSecondsPerMinute : wheel.belt_speed;
    belt::BeltLaw result;
    result.pressure_exponent = mean[force];
    result.speed_exponent = mean[speed];
    result.dwell_exponent = mean[duration];
    result.coefficient = std::exp(mean[level]) / area * std::pow(area / reference.force, mean[force]) *
                         std::pow(reference_speed, -mean[speed]) * std::pow(reference.duration, -mean[duration]);
    if (mean[wear] > 0) result.wear_work = law.belief.pass_work() / mean[wear] * travel / kSecondsPerMinute;
    return result;
}

json::Value to_json(const GantryLaw& law)
{
    json::Value value;
    const auto add = [&](const char* name, const std::optional<Measured>& measured) {
        if (measured) value.set(name, measured->value).set(std::string(name) + "_sigma", measured->sigma);
    };
    add("coefficient", law.coefficient);
    add("preload", law.preload);
    add("stiffness", law.stiffness);
    add("grinding_ratio", law.grinding_ratio);
    add("compliance", law.compliance);
    if (law.cells > 0)
        value.set("height_offset", law.height_offset).set("height_error", law.height_error).set("cells", law.cells);
    return value;
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

} // namespace fettle::calibrate
