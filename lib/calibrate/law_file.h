#pragma once

#include "calibrate/gantry_passes.h"
#include "calibrate/law_record.h"

#include <string>

namespace fettle::calibrate {

/// A file of kind "law": what was learnt, with the record (docs/formats.md). Its volumes are in mm³, its forces in N.
json::Value law_file(const json::Value& learnt);

/// The record of a file of kind "law", or of a wheel that was learnt.
/// @throws InputError if it is none
LawRecord read_law(const std::string& path);

/// A record with the passes of another. @param source  of those, for messages
/// @throws InputError if they record other quantities than those before
LawRecord continued(LawRecord record, const LawRecord& more, const std::string& source);

/// The members coefficient, preload, stiffness, grinding_ratio, compliance, each with its sigma, and what was left.
json::Value to_json(const GantryLaw& law);

} // namespace fettle::calibrate
