#include "belt_calibrate/belt_learning.h"

#include "belt_calibrate/belt_run.h"
#include "calibrate/law_file.h"
#include "calibrate/law_report.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

namespace fettle::belt_calibrate {
namespace {

using belt::ContactWheel;
using belt::MeasuredPass;
using Eigen::Index;
using Eigen::VectorXd;
using removal::RemovalTrial;

/// A belt that is so many times as sharp or as blunt as its wheel's file says is another belt.
constexpr double kMaxFeedFactor = 4;

/// Standard deviation of a part's logarithm over its distance from the simulation: so much of it the sensitivities,
/// which are those of the simulation, leave open.
constexpr double kLinearizationShare = 0.25;

/// Mean feed of the points, mm/s.
double mean_feed(const std::vector<belt::BeltPoint>& points)
{
    double sum = 0, count = 0;
    for (const belt::BeltPoint& point : points) {
        if (!point.is_on_part()) continue;
        sum += std::log(point.feed);
        ++count;
    }
    return std::exp(sum / std::max(count, 1.0));
}

/// The predicted volumes of a trial as those of its pass.
calibrate::Prediction as_measured(calibrate::Prediction predicted, const MeasuredPass& measured)
{
    for (double* volume : {&predicted.volume, &predicted.lower, &predicted.upper})
        *volume = measured.contact_volume * measured.trial.volume *
                  std::pow(*volume / measured.trial.volume, measured.sensitivity);
    return predicted;
}

} // namespace

BeltLearning::BeltLearning(const std::string& file, const belt::ContactWheel& wheel, const belt::BeltOptions& options,
                           const belt::Surfels& surfels, std::vector<belt::BeltPoint>& path)
    : wheel_(wheel), options_(options), surfels_(surfels), path_(path), lengths_(belt::tributary_lengths(path))
{
    options_.range.reset();
    record_.base = {wheel.law.pressure_exponent, wheel.law.feed_exponent};
    if (!std::filesystem::exists(file)) return;
    record_ = calibrate::read_law(file);
    const RemovalTrial& first = record_.passes.front();
    if (!std::isnan(first.speed) || std::isnan(first.feed) || !std::isnan(first.duration))
        throw core::InputError(core::display_name(file), "is no law of a belt that moves along paths");
    // A layer under its own modulus would be pressed through to the hub. Laws that were written before the release of
    // this version hold forces in N.
    for (const RemovalTrial& pass : record_.passes)
        if (pass.force > wheel.layer.young)
            throw core::InputError(core::display_name(file),
                                   "a pass has a pressure of " + core::to_short_text(pass.force) +
                                       " MPa, more than the modulus of the wheel's layer, " +
                                       core::to_short_text(wheel.layer.young) + ": it may be a force in N; learn anew");
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

RemovalTrial BeltLearning::trial_at(const ContactWheel& wheel, double pressure, double feed, double work) const
{
    return expected_trial(wheel, record_.base, pressure, feed, known_work_ + work);
}

ContactWheel BeltLearning::known_wheel(double pressure, double feed, double work) const
{
    ContactWheel wheel = wheel_;
    if (!law_) return wheel;
    const calibrate::Parameters offset = law_->belief.posterior().mean - calibrate::preston_exponents();
    // The ranges of a wheel's file.
    wheel.law.pressure_exponent =
        std::clamp(record_.base.pressure_exponent + offset[calibrate::Parameter::force], 0.0, 5.0);
    wheel.law.feed_exponent = std::clamp(record_.base.feed_exponent + offset[calibrate::Parameter::feed], -5.0, 5.0);
    const RemovalTrial planned = trial_at(wheel_, pressure, feed, work);
    const double ratio = law_->belief.predict(planned).volume / planned.volume;
    wheel.law.coefficient *= std::clamp(ratio, 1 / kMaxFeedFactor, kMaxFeedFactor) * planned.volume /
                             trial_at(wheel, pressure, feed, work).volume;
    return wheel;
}

ContactWheel BeltLearning::next_wheel() const
{
    const RemovalTrial next = next_pass(record_);
    return known_wheel(next.force, next.feed, next.prior_work - known_work_);
}

double BeltLearning::feed_factor(double pressure, double planned_feed, double work) const
{
    const double exponent =
        1 - wheel_.law.feed_exponent; // of the inverse of the feed, to which the depth is in proportion
    if (!law_ || !(exponent > 0)) return 1;
    constexpr int kRounds = 4; // the exponent of the feed that is believed differs little from the law's
    double factor = 1;
    for (int round = 0; round < kRounds; ++round) {
        const RemovalTrial trial = trial_at(wheel_, pressure, factor * planned_feed, work);
        const double ratio = law_->belief.predict(trial).volume / trial.volume;
        factor = std::clamp(std::pow(ratio, 1 / exponent), 1 / kMaxFeedFactor, kMaxFeedFactor);
    }
    return factor;
}

void BeltLearning::plan_pass(std::size_t first, std::size_t end)
{
    pass_ = {};
    pass_.first = first;
    pass_.end = end;
    pass_.planned.assign(path_.begin() + std::ptrdiff_t(first), path_.begin() + std::ptrdiff_t(end));
}

void BeltLearning::scale_feeds(double factor)
{
    pass_.feed_factor = factor;
    // A dwell removes with the dwell's exponent what a motion does.
    const double depth_factor = std::pow(factor, 1 - wheel_.law.feed_exponent);
    for (std::size_t k = 0; k < pass_.planned.size(); ++k) {
        belt::BeltPoint& point = path_[pass_.first + k];
        point.feed = pass_.planned[k].feed * factor;
        point.dwell = pass_.planned[k].dwell / std::pow(depth_factor, 1 / wheel_.law.dwell_exponent);
    }
}

void BeltLearning::resume(const belt::BeltRun& run)
{
    std::size_t first = 0;
    for (const MeasuredPass& measured : run.passes) {
        plan_pass(first, belt::end_of_pass(path_, first));
        first = pass_.end;
        scale_feeds(measured.feed_factor);
        add(measured);
    }
}

bool BeltLearning::simulate(const belt::BeltGrinding& grinding)
{
    belt::BeltOptions options = options_;
    options.prior_work += grinding.run().work;
    const std::vector<belt::BeltPoint> points(path_.begin() + std::ptrdiff_t(pass_.first),
                                              path_.begin() + std::ptrdiff_t(pass_.end));
    try {
        pass_.simulated = simulate_pass(surfels_, pass_.wheel, points, options, grinding.contact_grid());
        return pass_.simulated.run.removed.sum() > 0;
    } catch (const core::InputError&) {
        pass_.simulated = {}; // the pass itself will say what is wrong, and at which point
        return false;
    }
}

void BeltLearning::begin_pass(const belt::BeltGrinding& grinding, std::size_t first, std::size_t end)
{
    plan_pass(first, end);
    pass_.before = surfels_.displacement;
    const double work = grinding.run().work;
    double pressure = law_ ? record_.passes.back().force : 1, planned_feed = mean_feed(pass_.planned);
    // The pressures are those of the last pass until this one is simulated.
    constexpr int kRounds = 3;
    constexpr double kMaxChange = 0.01; // of the factor
    for (int round = 0; round < kRounds; ++round) {
        const double factor = feed_factor(pressure, planned_feed, work);
        if (round > 0 && std::abs(factor / pass_.feed_factor - 1) < kMaxChange) break;
        scale_feeds(factor);
        pass_.wheel = known_wheel(pressure, factor * planned_feed, work);
        if (!simulate(grinding)) break;
        pressure = pass_.simulated.pressure;
        planned_feed = pass_.simulated.feed / factor;
    }
}

MeasuredPass BeltLearning::end_pass(const belt::BeltRun& run)
{
    MeasuredPass measured;
    measured.feed_factor = pass_.feed_factor;
    double impulse = 0, length = 0; // N s, mm
    for (std::size_t k = pass_.first; k < pass_.end; ++k) {
        const belt::BeltTrace& at = run.trace[k];
        if (std::isnan(at.force)) continue;
        impulse += at.force * at.duration;
        length += lengths_[Index(k)];
    }
    measured.work = impulse * wheel_.belt_speed;
    const double work = std::max(0.0, run.work - measured.work); // before the first pass, but for rounding
    const SimulatedPass& simulated = pass_.simulated;
    const VectorXd lost = pass_.before - surfels_.displacement;
    const double depth = lost.array().isFinite().select(lost, 0).sum(), expected = simulated.run.removed.sum();
    if (length > 0 && depth > 0 && expected > 0) {
        measured.trial = trial_at(pass_.wheel, simulated.pressure, simulated.feed, work);
        measured.sensitivity = simulated.pass_sensitivity;
        measured.trial.volume *= std::pow(depth / expected, 1 / measured.sensitivity);
        measured.contact_volume = simulated.run.removed_volume * depth / expected / measured.trial.volume;
        for (const PassPart& part : divide_pass(simulated, lost)) {
            RemovalTrial& trial = measured.parts.emplace_back(trial_at(pass_.wheel, part.pressure, part.feed, work));
            trial.volume *= part.ratio;
            trial.deviation = kLinearizationShare * std::abs(std::log(part.ratio));
        }
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
        law_.emplace(calibrate::LearntLaw{calibrate::LawBelief(trial, measured.work), {}});
    }
    learn_pass(*law_, trial, measured.parts);
    for (const RemovalTrial& part : measured.parts) record_.parts.push_back({record_.passes.size(), part});
    record_.passes.push_back(trial);
    passes_.push_back(pass);
}

std::vector<std::string> BeltLearning::warnings() const
{
    std::vector<std::string> lines;
    for (std::size_t k = 0; k < passes_.size(); ++k) {
        calibrate::JudgedPass judged = law_->passes[known_passes_ + k];
        if (!judged.has_change) continue;
        const RunPass& pass = passes_[k];
        judged.pass.volume *= pass.measured.contact_volume;
        judged.predicted = as_measured(judged.predicted, pass.measured);
        lines.push_back(calibrate::change_message(judged, pass.number));
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
            const calibrate::Prediction volumes = as_measured(*predicted, measured);
            value.set("expected", volumes.volume).set("lower", volumes.lower).set("upper", volumes.upper);
        }
        predictions.push_back(value.set("change", law_->passes[known_passes_ + k].has_change));
    }
    const belt::BeltLaw next = next_wheel().law;
    const calibrate::ParameterMatrix covariance = law_->belief.posterior().covariance;
    return calibrate::run_report(*law_, known_passes_, next_pass(record_))
        .set("coefficient", next.coefficient)
        .set("pressure_exponent", next.pressure_exponent)
        .set("pressure_exponent_sigma", std::sqrt(covariance(calibrate::Parameter::force, calibrate::Parameter::force)))
        .set("feed_exponent", next.feed_exponent)
        .set("feed_exponent_sigma", std::sqrt(covariance(calibrate::Parameter::feed, calibrate::Parameter::feed)))
        .set("predictions", predictions);
}

json::Value BeltLearning::file() const
{
    ContactWheel learnt = next_wheel();
    learnt.law_source = "fettle-belt --learn";
    return belt::to_json(learnt).set("learnt", to_json(*law_).set("record", to_json(record_)));
}

} // namespace fettle::belt_calibrate
