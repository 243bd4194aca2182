#pragma once

#include "belt/contact_wheel.h"
#include "belt_calibrate/belt_run.h"
#include "calibrate/law_record.h"
#include "json/document.h"

namespace fettle::belt_calibrate {

/// The law for a wheel's file, from trials of a belt at rest: the pressure is the force over the contact.
/// @param area  of the contact, mm²   @param travel  of the belt in a unit of the trials' speed and a minute, mm
/// @throws InputError if the trials have no duration
belt::BeltLaw belt_law(const calibrate::LearntLaw& law, const belt::ContactWheel& wheel, double area, double travel);

/// The members parameters, covariance, reference_pressure, reference_feed, depth_error, surfels.
json::Value to_json(const BeltRunLaw& law);

} // namespace fettle::belt_calibrate
