#include "calibrate/run_learning.h"

#include "calibrate/gantry_passes.h"
#include "calibrate/law_file.h"
#include "calibrate/law_report.h"
#include "core/error.h"
#include "core/file.h"

#include <cmath>
#include <filesystem>

namespace fettle::calibrate {

using removal::RemovalTrial;

namespace {

/// Standard deviation of the change of the grinding ratio from part to part, relative: it wanders.
constexpr double kWearDriftPerRun = 0.05;

} // namespace

RunLearning::RunLearning(const std::string& path)
{
    if (!std::filesystem::exists(path)) return;
    record_ = read_law(path);
    const RemovalTrial& first = record_.passes.front();
    if (!std::isnan(first.speed) || !std::isnan(first.feed) || !std::isnan(first.duration))
        throw core::InputError(core::display_name(path), "is the law of a belt, not of a gantry");
    known_passes_ = record_.passes.size();
}

double RunLearning::coefficient(const LearntLaw& law) const
{
    const RemovalTrial next = next_pass(record_);
    return law.belief.predict(next).volume / next.force;
}

job::Job RunLearning::informed(job::Job job) const
{
    if (is_informed()) job.removal_coefficient = coefficient(learn(record_));
    return job;
}

std::optional<strategy::KnownRemoval> RunLearning::known() const
{
    if (!is_informed()) return std::nullopt;
    strategy::KnownRemoval known;
    const LawBelief belief = learn(record_).belief;
    known.coefficient_sigma = std::sqrt(belief.information(next_pass(record_))) * belief.posterior().scatter;
    const std::optional<Measured> wear = fit_wear(record_.wear);
    if (!wear) return known;
    for (const WearInterval& interval : record_.wear) known.removed_volume += interval.removed;
    known.lost_volume = wear->value * known.removed_volume;
    known.wear_sigma =
        std::hypot(wear->sigma / wear->value, kWearDriftPerRun * std::sqrt(record_.runs_without_wear + 1));
    return known;
}

void RunLearning::learn_from(const std::vector<strategy::TraceRow>& trace, const job::Job& job,
                             const removal::HeightField& before)
{
    const GantryLaw run = measure_gantry(trace, job, before, std::nullopt);
    known_passes_ = record_.passes.size();
    add_wear(record_, run.wear);
    if (run.passes.empty()) return;
    if (known_passes_ == 0) record_.pass_work = run.pass_work;
    const double work = known_passes_ > 0 ? next_pass(record_).prior_work : 0;
    for (RemovalTrial pass : run.passes) {
        pass.prior_work += work;
        record_.passes.push_back(pass);
    }
}

std::vector<std::string> RunLearning::warnings() const
{
    std::vector<std::string> lines;
    if (!is_informed()) return lines;
    const LearntLaw law = learn(record_);
    for (std::size_t k = known_passes_; k < law.passes.size(); ++k)
        if (law.passes[k].has_change) lines.push_back(change_message(law.passes[k], k - known_passes_ + 1));
    return lines;
}

json::Value RunLearning::report() const
{
    if (!is_informed()) return json::Value().set("passes", 0);
    const LearntLaw law = learn(record_);
    json::Value report = run_report(law, known_passes_, next_pass(record_)).set("coefficient", coefficient(law));
    const strategy::KnownRemoval next = *known();
    report.set("coefficient_sigma", next.coefficient_sigma);
    if (next.lost_volume > 0)
        report.set("grinding_ratio", next.removed_volume / next.lost_volume)
            .set("grinding_ratio_sigma", next.wear_sigma);
    return report;
}

json::Value RunLearning::file() const
{
    if (!is_informed()) return {};
    return law_file(to_json(learn(record_)).set("record", to_json(record_)));
}

} // namespace fettle::calibrate
