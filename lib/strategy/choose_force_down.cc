#include "strategy/choose_force_down.h"

#include "core/error.h"
#include "core/text.h"
#include "plan/plan.h"
#include "strategy/run.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <vector>

namespace fettle::strategy {
namespace {

/// Values of F_down that are tried, as positions between F_min and F_max. At F_max the distance of the layers would be
/// 0; at the last value it is a tenth of their thickness.
constexpr std::array<double, 7> kShares = {0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9};

ForceDownTrial try_force_down(job::Job job, const surface::Surface& surface, const MakeGantry& make_gantry,
                              double share)
{
    job.force.down = job.force.min + share * (job.force.max - job.force.min);
    const plan::Plan plan = plan::make_plan(job, surface);
    const std::unique_ptr<gantry::Gantry> gantry = make_gantry(plan.job);
    const GrindRun run = strategy::run(plan, *gantry);
    return {job.force.down,           run.finished,      run.failure,        run.trace.back().time,     run.force.peak,
            run.counts.highest_layer, run.counts.raises, run.counts.re_cuts, run.counts.skipped_re_cuts};
}

} // namespace

ForceDownChoice choose_force_down(const job::Job& job, const surface::Surface& surface, const MakeGantry& make_gantry)
{
    ForceDownChoice choice;
    choice.trials.resize(kShares.size());
    tbb::parallel_for(std::size_t{0}, kShares.size(),
                      [&](std::size_t i) { choice.trials[i] = try_force_down(job, surface, make_gantry, kShares[i]); });
    choice.chosen = choice.trials.size();
    for (std::size_t i = 0; i < choice.trials.size(); ++i)
        if (choice.trials[i].finished && (choice.chosen == choice.trials.size() ||
                                          choice.trials[i].machine_time < choice.trials[choice.chosen].machine_time))
            choice.chosen = i;
    if (choice.chosen == choice.trials.size())
        throw core::InputError(job.source,
                               "force.down: the work finishes with no value, with the smallest not because of: " +
                                   choice.trials.front().failure);
    return choice;
}

json::Value to_json(const ForceDownChoice& choice, const units::Units& units)
{
    // Conversion to N and back makes 6.500000000000001 of 6.5 lbf.
    const auto in_units = [&](double force) { return std::round(force / units.newton() * 1e9) / 1e9; };
    std::vector<json::Value> trials;
    for (const ForceDownTrial& trial : choice.trials)
        trials.push_back(json::Value()
                             .set("force_down", in_units(trial.force_down))
                             .set("finished", trial.finished)
                             .set("machine_time", trial.machine_time)
                             .set("peak_force", trial.peak_force / units.newton())
                             .set("layers", trial.layers)
                             .set("raises", trial.raises)
                             .set("re_cuts", trial.re_cuts)
                             .set("skipped_re_cuts", trial.skipped_re_cuts));
    return json::Value().set("chosen", in_units(choice.trials[choice.chosen].force_down)).set("trials", trials);
}

} // namespace fettle::strategy
