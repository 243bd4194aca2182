#pragma once

#include "cloud/cloud.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <string>
#include <vector>

namespace fettle::strategy {

/// A point for each row, frame M, with fields t, layer, pass, event, force, feed, peak_force, deflection, radius
/// (docs/formats.md).
cloud::Cloud to_cloud(const std::vector<TraceRow>& trace);
/// Inverse of to_cloud.
/// @throws InputError if a field is missing or has a value that no trace has
std::vector<TraceRow> trace_from_cloud(const cloud::Cloud& cloud, const std::string& source);

/// The ground part as the machine itself knows it: the stock minus the volume that the wheel swept while it ground,
/// with the radius that was measured last, or the job's before the first measurement. The wear since is not known.
removal::HeightField replay_removal(const std::vector<TraceRow>& trace, const job::Job& job,
                                    removal::HeightField stock);

} // namespace fettle::strategy
