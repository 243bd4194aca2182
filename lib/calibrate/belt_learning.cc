#include "calibrate/belt_learning.h"

#include "calibrate/belt_run.h"
#include "calibrate/law_file.h"
#include "calibrate/law_report.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

namespace fettle::calibrate {
namespace {

using belt::MeasuredPass;
using belt::RemovalTrial;
using Eigen::Index;
using Eigen::VectorXd;

/// A belt that is so many times as sharp or as blunt as its wheel's file says is another belt.
constexpr double kMaxFeedFactor = 4;

/// Sums over the points of a pass.
struct PassSums {
    double impulse = 0, time = 0, length = 0; ///< N s, s, mm

    double force() const { return impulse / time; }
    double feed() const { return length / time; }
};

/// The predicted volumes of a trial as those of its pass.
Prediction as_measured(Prediction predicted, double contact_volume)
{
    predicted.volume *= contact_volume;
    predicted.lower *= contact_volume;
    predicted.upper *= contact_volume;
    return predicted;
}

} // namespace

BeltLearning::BeltLearning(const std::string& file, const belt::ContactWheel& wheel, const belt::BeltOptions& options,
                           const belt::Surfels& surfels, std::vector<belt::BeltPoint>& path)
    : wheel_(wheel), options_(options), surfels_(surfels), path_(path), lengths_(belt::tributary_lengths(path))
{
    options_.range.reset();
    options_.keep_removals = false;
    if (!std::filesystem::exists(file)) return;
    record_ = read_law(file);
    const RemovalTrial& first = record_.passes.front();
    if (!std::isnan(first.speed) || std::isnan(first.feed) || !std::isnan(first.duration))
        throw core::InputError(core::display_name(file), "is no law of a belt that moves along paths");
    law_ = learn(record_);
    known_passes_ = record_.passes.size();
    known_work_ = next_pass(record_).prior_work;
}

std::string BeltLearning::context_digest() const
{
    std::ostringstream text;
    text << belt::to_json(wheel_) << to_json(record_);
    return core::sha256(text.str());
}

RemovalTrial BeltLearning::trial_at(double force, double feed, double work) const
{
    return expected_trial(wheel_, force, feed, known_work_ + work);
}

double BeltLearning::coefficient_ratio(const RemovalTrial& conditions) const
{
    return law_ ? law_->belief.predict(conditions).volume / conditions.volume : 1;
}

double BeltLearning::expected_ratio() const
{
    const RemovalTrial next = next_pass(record_);
    return coefficient_ratio(trial_at(next.force, next.feed, next.prior_work - known_work_));
}

/// The factor for the feeds of the pass by which it removes as much as its path was planned for.
double BeltLearning::feed_factor(double work) const
{
    const double exponent =
        1 - wheel_.law.feed_exponent; // of the inverse of the feed, to which the depth is in proportion
    if (!law_ || !(exponent > 0)) return 1;
    PassSums sums;
    for (std::size_t k = pass_.first; k < pass_.end; ++k) {
        const belt::BeltPoint& point = path_[k];
        if (!point.is_on_part()) continue;
        const double duration = lengths_[Index(k)] / point.feed + point.dwell;
        sums.impulse += duration * (point.load.by_force ? point.load.value : record_.passes.back().force);
        sums.time += duration;
        sums.length += lengths_[Index(k)];
    }
    if (!(sums.length > 0)) return 1;
    constexpr int kRounds = 4; // the exponent of the feed that is believed differs little from the law's
    double factor = 1;
    for (int round = 0; round < kRounds; ++round) {
        const double ratio = coefficient_ratio(trial_at(sums.force(), factor * sums.feed(), work));
        factor = std::clamp(std::pow(ratio, 1 / exponent), 1 / kMaxFeedFactor, kMaxFeedFactor);
    }
    return factor;
}

void BeltLearning::scale_feeds(double factor)
{
    // A dwell removes with the dwell's exponent what a motion does.
    const double depth_factor = std::pow(factor, 1 - wheel_.law.feed_exponent);
    for (std::size_t k = pass_.first; k < pass_.end; ++k) {
        path_[k].feed *= factor;
        path_[k].dwell /= std::pow(depth_factor, 1 / wheel_.law.dwell_exponent);
    }
}

void BeltLearning::resume(const belt::BeltRun& run)
{
    std::size_t first = 0;
    for (const MeasuredPass& measured : run.passes) {
        pass_.first = first;
        pass_.end = first = belt::end_of_pass(path_, first);
        scale_feeds(measured.feed_factor);
        add(measured);
    }
}

void BeltLearning::begin_pass(const belt::BeltGrinding& grinding, std::size_t first, std::size_t end)
{
    pass_ = {first, end, surfels_.displacement, {}, 1, 1};
    const double work = grinding.run().work;
    pass_.feed_factor = feed_factor(work);
    scale_feeds(pass_.feed_factor);
    const double depth_factor = std::pow(pass_.feed_factor, 1 - wheel_.law.feed_exponent);
    pass_.ratio = depth_factor; // the belief's, within kMaxFeedFactor

    belt::Surfels surfels = surfels_;
    belt::ContactWheel wheel = wheel_;
    wheel.law.coefficient *= pass_.ratio;
    belt::BeltOptions options = options_;
    options.prior_work += work;
    const std::vector<belt::BeltPoint> points(path_.begin() + std::ptrdiff_t(first),
                                              path_.begin() + std::ptrdiff_t(end));
    try {
        belt::BeltGrinding simulation(surfels, wheel, points, options);
        simulation.set_contact_grid(grinding.contact_grid()); // cells of another size would take another depth
        while (!simulation.is_done()) simulation.step();
        pass_.simulated = simulation.run();
    } catch (const core::InputError&) {
        pass_.simulated = {}; // the pass itself will say what is wrong, and at which point
    }
}

MeasuredPass BeltLearning::end_pass(const belt::BeltRun& run)
{
    MeasuredPass measured;
    measured.feed_factor = pass_.feed_factor;
    PassSums sums;
    for (std::size_t k = pass_.first; k < pass_.end; ++k) {
        const belt::BeltTrace& at = run.trace[k];
        if (std::isnan(at.force)) continue;
        sums.impulse += at.force * at.duration;
        sums.time += at.duration;
        sums.length += lengths_[Index(k)];
    }
    measured.work = sums.impulse * wheel_.belt_speed;
    const VectorXd lost = pass_.before - surfels_.displacement;
    const double depth = lost.array().isFinite().select(lost, 0).sum();
    const double simulated = pass_.simulated.removed.size() > 0 ? pass_.simulated.removed.sum() : 0;
    if (sums.length > 0 && depth > 0 && simulated > 0) {
        measured.trial = trial_at(sums.force(), sums.feed(), run.work - measured.work);
        measured.trial.volume *= pass_.ratio * depth / simulated;
        measured.contact_volume = pass_.simulated.removed_volume * depth / simulated / measured.trial.volume;
    }
    add(measured);
    return measured;
}

void BeltLearning::add(const MeasuredPass& measured)
{
    ++path_passes_;
    const RemovalTrial& trial = measured.trial;
    if (!(trial.volume > 0)) return;
    RunPass pass{measured, path_passes_, std::nullopt};
    if (law_) {
        pass.predicted = law_->belief.predict(trial);
    } else {
        record_.pass_work = measured.work;
        law_.emplace(LearntLaw{LawBelief(trial, measured.work), {}});
    }
    learn_pass(*law_, trial);
    record_.passes.push_back(trial);
    passes_.push_back(pass);
}

std::vector<std::string> BeltLearning::warnings() const
{
    std::vector<std::string> lines;
    for (std::size_t k = 0; k < passes_.size(); ++k) {
        JudgedPass judged = law_->passes[known_passes_ + k];
        if (!judged.has_change) continue;
        const RunPass& pass = passes_[k];
        judged.pass.volume *= pass.measured.contact_volume;
        judged.predicted = as_measured(judged.predicted, pass.measured.contact_volume);
        lines.push_back(change_message(judged, pass.number));
    }
    return lines;
}

json::Value BeltLearning::report() const
{
    if (!law_) return json::Value().set("passes", 0);
    std::vector<json::Value> predictions;
    for (std::size_t k = 0; k < passes_.size(); ++k) {
        const auto& [measured, number, predicted] = passes_[k];
        json::Value value;
        value.set("pass", number)
            .set("volume", measured.trial.volume * measured.contact_volume)
            .set("feed_factor", measured.feed_factor);
        if (predicted) {
            const Prediction volumes = as_measured(*predicted, measured.contact_volume);
            value.set("expected", volumes.volume).set("lower", volumes.lower).set("upper", volumes.upper);
        }
        predictions.push_back(value.set("change", law_->passes[known_passes_ + k].has_change));
    }
    return run_report(*law_, known_passes_, next_pass(record_))
        .set("coefficient", wheel_.law.coefficient * expected_ratio())
        .set("predictions", predictions);
}

json::Value BeltLearning::file() const
{
    belt::ContactWheel learnt = wheel_;
    learnt.law.coefficient *= expected_ratio();
    learnt.law_source = "fettle-belt --learn";
    return belt::to_json(learnt).set("learnt", to_json(*law_).set("record", to_json(record_)));
}

} // namespace fettle::calibrate
