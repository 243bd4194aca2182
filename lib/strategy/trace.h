#pragma once

#include "cloud/cloud.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <vector>

namespace fettle {

/// A point for each row, frame M, with fields t, layer, pass, event, force, feed (docs/formats.md).
Cloud to_cloud(const std::vector<TraceRow>& trace);

/// What the machine itself knows of the ground part: the stock without what the wheel, where it stood while it ground,
/// took the place of. Its wear between two measurements is not known.
HeightField ground_by(const std::vector<TraceRow>& trace, const Job& job, HeightField stock);

} // namespace fettle
