#include "strategy/run_json.h"

#include "json/units.h"

#include <cmath>

namespace fettle::strategy {

json::Value to_json(const GrindRun& run, double removed, const units::Units& units)
{
    return json::Value()
        .set("kind", "grinding")
        .set("units", json::to_json(units))
        .set("finished", run.finished)
        .set("machine_time", run.trace.back().time)
        .set("layers", run.counts.highest_layer)
        .set("coverings", run.counts.coverings)
        .set("strokes", run.counts.strokes)
        .set("re_cuts", run.counts.re_cuts)
        .set("skipped_re_cuts", run.counts.skipped_re_cuts)
        .set("raises", run.counts.raises)
        .set("passes", run.counts.passes)
        .set("steps", run.counts.steps)
        .set("peak_force", run.force.peak / units.newton())
        .set("peak_layer", run.force.peak_layer)
        .set("peak_at", json::Value(Eigen::VectorXd(run.force.peak_at / units.mm())))
        .set("contact_time", run.force.contact_time)
        .set("in_range", run.force.in_range)
        .set("touch_offs", run.touch_offs)
        .set("wheel_changes", run.wheel_changes)
        .set("wheel_radius", run.wheel_radius / units.mm())
        .set("removed_volume", removed / std::pow(units.mm(), 3));
}

json::Value to_json(const ManualRun& run, double removed, const units::Units& units)
{
    return json::Value()
        .set("kind", "manual")
        .set("units", json::to_json(units))
        .set("contact_time", run.contact_time)
        .set("within", run.share_in_band)
        .set("peak_force", run.peak_force / units.newton())
        .set("removed_volume", removed / std::pow(units.mm(), 3));
}

} // namespace fettle::strategy
