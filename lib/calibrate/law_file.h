#pragma once

#include "belt/contact_wheel.h"
#include "calibrate/belt_run.h"
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

/// The law for a wheel's file, from trials of a belt at rest: the pressure is the force over the contact.
/// @param area  of the contact, mm²   @param travel  of the belt in a unit of the trials' speed and a minute, mm
/// @throws InputError if the trials have no duration
belt::BeltLaw belt_law(const LearntLaw& law, const belt::ContactWheel& wheel, double area, double travel);

/// The members coefficient, preload, stiffness, grinding_ratio, compliance, each with its sigma, and what was left.
json::Value to_json(const GantryLaw& law);
/// The members parameters, covariance, reference_pressure, reference_feed, depth_error, surfels.
json::Value to_json(const BeltRunLaw& law);

} // namespace fettle::calibrate
