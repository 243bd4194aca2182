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
    for (const removal::RemovalTrial& pass : more.passes) {
        for (const Factor& factor : kFactors)
            if (std::isnan(pass.*factor.value) != std::isnan(record.passes.front().*factor.value))
                throw core::InputError(source, std::string("records other conditions than the known law: ") +
                                                   kParameterNames[factor.parameter]);
        record.passes.push_back(rebased(pass, more.base, record.base));
    }
    return record;
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
    add("tangential", law.tangential);
    add("grinding_ratio", law.grinding_ratio);
    add("compliance", law.compliance);
    if (law.cells > 0)
        value.set("height_offset", law.height_offset).set("height_error", law.height_error).set("cells", law.cells);
    return value;
}

} // namespace fettle::calibrate
