#include "calibrate/law_record.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>
#include <limits>

namespace fettle::calibrate {
namespace {

using belt::RemovalTrial;

/// Passes with a smaller two-sided probability of tail have a change. One false alarm in 200 passes is allowed; some
/// law in five has heavier tails than any model here.
constexpr double kMaxChangeProbability = 1.0 / 300;

struct RecordColumn {
    const char* name;
    double RemovalTrial::*value;
    bool may_be_unrecorded;
};
constexpr RecordColumn kRecordColumns[] = {
    {"force", &RemovalTrial::force, false},     {"speed", &RemovalTrial::speed, true},
    {"feed", &RemovalTrial::feed, true},        {"duration", &RemovalTrial::duration, true},
    {"work", &RemovalTrial::prior_work, false}, {"volume", &RemovalTrial::volume, false}};

} // namespace

void learn_pass(LearntLaw& law, const belt::RemovalTrial& pass)
{
    JudgedPass judged{pass, {}, law.passes.size() >= kFirstJudged, false};
    if (judged.is_judged) {
        judged.predicted = law.belief.predict(pass);
        judged.has_change = judged.predicted.tail_probability < kMaxChangeProbability;
        if (judged.has_change) law.belief.loosen_level();
    }
    law.belief.update(pass);
    law.passes.push_back(judged);
}

LearntLaw learn(const LawRecord& record)
{
    if (record.passes.empty()) throw core::InputError("there is no pass to learn from");
    LearntLaw law{LawBelief(record.passes.front(), record.pass_work), {}};
    for (std::size_t k = 0; k < record.passes.size(); ++k) {
        try {
            learn_pass(law, record.passes[k]);
        } catch (const core::InputError& error) {
            throw core::InputError("pass " + std::to_string(k + 1), error.what());
        }
    }
    return law;
}

void add_wear(LawRecord& record, const std::vector<WearInterval>& run)
{
    constexpr std::ptrdiff_t kMaxWearIntervals = 20; // of some five runs
    std::vector<WearInterval>& wear = record.wear;
    record.runs_without_wear = run.empty() ? record.runs_without_wear + 1 : 0;
    wear.insert(wear.end(), run.begin(), run.end());
    if (std::ssize(wear) > kMaxWearIntervals) wear.erase(wear.begin(), wear.end() - kMaxWearIntervals);
}

RemovalTrial next_pass(const LawRecord& record)
{
    RemovalTrial next = record.passes.back();
    next.volume = 0;
    next.prior_work += record.pass_work;
    double force = 0, feed = 0;
    for (const RemovalTrial& pass : record.passes) {
        force += pass.force / record.passes.size();
        feed += pass.feed / record.passes.size();
    }
    next.force = force;
    next.feed = feed;
    return next;
}

std::string change_message(const JudgedPass& pass, std::size_t number)
{
    const Prediction& predicted = pass.predicted;
    const bool is_less = pass.pass.volume < predicted.volume;
    return "pass " + std::to_string(number) + " took " + core::to_short_text(pass.pass.volume) + " mm³, where " +
           core::to_short_text(predicted.lower) + " to " + core::to_short_text(predicted.upper) + " were expected: " +
           (is_less ? "the wheel is blunt or loaded, or the material is harder"
                    : "the wheel is sharper, or the material is softer");
}

json::Value to_json(const LawRecord& record)
{
    Eigen::MatrixXd rows(record.passes.size(), std::size(kRecordColumns));
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
        for (std::size_t k = 0; k < std::size(kRecordColumns); ++k) {
            const double value = record.passes[i].*kRecordColumns[k].value;
            rows(i, k) = std::isnan(value) ? 0 : value;
        }
    json::Value value = json::Value().set("pass_work", record.pass_work).set("passes", rows);
    if (record.wear.empty()) return value;
    Eigen::MatrixXd wear(record.wear.size(), 2);
    for (Eigen::Index i = 0; i < wear.rows(); ++i) wear.row(i) << record.wear[i].removed, record.wear[i].lost;
    return value.set("wear", wear).set("runs_without_wear", record.runs_without_wear);
}

LawRecord read_record(json::Reader reader)
{
    LawRecord record;
    record.pass_work = reader.number("pass_work", core::Range::positive());
    const Eigen::MatrixXd rows = reader.matrix("passes", std::size(kRecordColumns));
    for (const auto& row : rows.rowwise()) {
        RemovalTrial& pass = record.passes.emplace_back();
        for (std::size_t k = 0; k < std::size(kRecordColumns); ++k) {
            const RecordColumn& column = kRecordColumns[k];
            const bool is_work = column.value == &RemovalTrial::prior_work;
            if (!(row[k] > 0 || (row[k] == 0 && (is_work || column.may_be_unrecorded))))
                reader.refuse("passes", "pass " + std::to_string(record.passes.size()) + ": the " + column.name +
                                            " is not positive, got " + core::to_short_text(row[k]));
            pass.*column.value = row[k] > 0 || is_work ? row[k] : std::numeric_limits<double>::quiet_NaN();
        }
    }
    if (record.passes.empty()) reader.refuse("passes", "is empty");
    if (reader.has("wear")) {
        const Eigen::MatrixXd wear = reader.matrix("wear", 2);
        for (const auto& row : wear.rowwise()) {
            if (!(row[0] >= 0 && row[1] > 0)) reader.refuse("wear", "has a row whose lost volume is not positive");
            record.wear.push_back({.removed = row[0], .lost = row[1]});
        }
        record.runs_without_wear = reader.integer("runs_without_wear", 0, std::numeric_limits<int>::max());
    }
    reader.reject_unknown_keys();
    return record;
}

} // namespace fettle::calibrate
