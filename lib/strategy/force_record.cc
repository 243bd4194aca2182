#include "strategy/force_record.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle::strategy {

void ForceRecord::add(const gantry::GantryStatus& status, int layer, double duration, const job::ForceRange& limits)
{
    const double force = std::max(status.force, status.peak_force);
    if (force > peak) {
        peak = force;
        peak_at = status.commanded + status.deflection * Eigen::Vector3d::UnitZ();
        peak_layer = layer;
    }
    if (layer == 1 || !(status.force > 0) || !(duration > 0)) return;
    const bool within = status.force >= limits.min && status.force <= limits.max;
    const double time_in_range = in_range * contact_time + (within ? duration : 0);
    contact_time += duration;
    in_range = time_in_range / contact_time;
}

std::string peak_warning(const ForceRecord& record, const job::Job& job)
{
    if (!(record.peak > kMaxPeakShare * job.force.max)) return {};
    const double mm = job.units.mm();
    return "the force came to " + core::to_short_text(record.peak / job.units.newton()) + " " +
           units::to_string(job.units.force) + ", " + core::to_text(std::round(100 * record.peak / job.force.max)) +
           " % of force.max, in layer " + std::to_string(record.peak_layer) + " at x " +
           core::to_short_text(record.peak_at.x() / mm) + ", y " + core::to_short_text(record.peak_at.y() / mm) +
           ", z " + core::to_short_text(record.peak_at.z() / mm);
}

} // namespace fettle::strategy
