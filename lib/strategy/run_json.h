#pragma once

#include "strategy/manual.h"
#include "strategy/run.h"
#include "units/units.h"
#include "json/document.h"

namespace fettle::strategy {

/// The reports of fettle-grind and fettle-manual (docs/formats.md). @param removed  volume, mm³
json::Value to_json(const GrindRun& run, double removed, const units::Units& units);
json::Value to_json(const ManualRun& run, double removed, const units::Units& units);

} // namespace fettle::strategy
