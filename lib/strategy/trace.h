#pragma once

#include "cloud/cloud.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <string>
#include <vector>

namespace fettle {

/// @param radius  of the wheel, as measured last, mm   @param feed  0: not grinding
TraceRow row_of(const GantryStatus& status, double radius, double feed);
GantryStatus status_of(const TraceRow& row);

/// A point for each row, frame M, with fields t, layer, pass, event, force, feed, peak_force, deflection, radius
/// (docs/formats.md).
Cloud to_cloud(const std::vector<TraceRow>& trace);
/// @throws InputError if a field is not there or no trace's
std::vector<TraceRow> trace_of(const Cloud& cloud, const std::string& source);

/// What the machine itself knows of the ground part: the stock without what the wheel, where it stood while it ground,
/// took the place of. Its wear between two measurements is not known.
HeightField ground_by(const std::vector<TraceRow>& trace, const Job& job, HeightField stock);

} // namespace fettle
