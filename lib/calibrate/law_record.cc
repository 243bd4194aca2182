#include "calibrate/law_record.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>
#include <limits>

namespace fettle::calibrate {
namespace {

using removal::RemovalTrial;

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

constexpr Eigen::Index kColumnCount = std::size(kRecordColumns);
using Row = Eigen::Matrix<double, 1, kColumnCount>;

Row to_row(const RemovalTrial& trial)
{
    Row row;
    for (Eigen::Index k = 0; k < kColumnCount; ++k) {
        const double value = trial.*kRecordColumns[k].value;
        row[k] = std::isnan(value) ? 0 : value;
    }
    return row;
}

/// @param place  of the row, for messages
RemovalTrial read_row(const Row& row, json::Reader& reader, const char* key, const std::string& place)
{
    RemovalTrial trial;
    for (Eigen::Index k = 0; k < kColumnCount; ++k) {
        const RecordColumn& column = kRecordColumns[k];
        const bool is_work = column.value == &RemovalTrial::prior_work;
        if (!(row[k] > 0 || (row[k] == 0 && (is_work || column.may_be_unrecorded))))
            reader.refuse(key, place + ": the " + column.name + " is not positive, got " + core::to_short_text(row[k]));
        trial.*column.value = row[k] > 0 || is_work ? row[k] : std::numeric_limits<double>::quiet_NaN();
    }
    return trial;
}

void read_parts(json::Reader& reader, LawRecord& record)
{
    if (!reader.has("parts")) return;
    const Eigen::MatrixXd rows = reader.matrix("parts", 1 + kColumnCount + 1);
    double last = 1;
    for (const auto& row : rows.rowwise()) {
        const std::string place = "row " + std::to_string(record.parts.size() + 1);
        if (!(row[0] >= last && row[0] <= double(record.passes.size()) && row[0] == std::floor(row[0])))
            reader.refuse("parts", place + ": the number of the pass is not one of the record, or not in order, got " +
                                       core::to_short_text(row[0]));
        last = row[0];
        PartTrial part{std::size_t(last) - 1, read_row(row.segment<kColumnCount>(1), reader, "parts", place)};
        part.trial.deviation = row[1 + kColumnCount];
        if (!(part.trial.deviation >= 0)) reader.refuse("parts", place + ": the deviation is negative");
        record.parts.push_back(part);
    }
}

} // namespace

removal::RemovalTrial rebased(removal::RemovalTrial trial, const TrialBase& from, const TrialBase& to)
{
    trial.volume *= std::pow(trial.force, from.pressure_exponent - to.pressure_exponent) *
                    std::pow(trial.feed, from.feed_exponent - to.feed_exponent);
    return trial;
}

void learn_pass(LearntLaw& law, const RemovalTrial& pass, const std::vector<RemovalTrial>& parts)
{
    JudgedPass judged{pass, parts, {}, law.passes.size() >= kFirstJudged, false};
    if (judged.is_judged) {
        judged.predicted = law.belief.predict(pass);
        judged.has_change = judged.predicted.tail_probability < kMaxChangeProbability;
        if (judged.has_change) law.belief.loosen_level();
    }
    law.belief.update(parts.empty() ? std::vector{pass} : parts);
    law.passes.push_back(judged);
}

LearntLaw learn(const LawRecord& record)
{
    if (record.passes.empty()) throw core::InputError("there is no pass to learn from");
    LearntLaw law{LawBelief(record.passes.front(), record.pass_work), {}};
    auto part = record.parts.begin();
    for (std::size_t k = 0; k < record.passes.size(); ++k) {
        std::vector<RemovalTrial> parts;
        for (; part != record.parts.end() && part->pass == k; ++part) parts.push_back(part->trial);
        try {
            learn_pass(law, record.passes[k], parts);
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
    Eigen::MatrixXd rows(record.passes.size(), kColumnCount);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = to_row(record.passes[i]);
    json::Value value = json::Value().set("pass_work", record.pass_work).set("passes", rows);
    if (!record.parts.empty()) {
        Eigen::MatrixXd parts(record.parts.size(), 1 + kColumnCount + 1);
        for (Eigen::Index i = 0; i < parts.rows(); ++i) {
            const auto& [pass, trial] = record.parts[i];
            parts.row(i) << double(pass + 1), to_row(trial), trial.deviation;
        }
        value.set("parts", parts);
    }
    const TrialBase preston;
    if (record.base.pressure_exponent != preston.pressure_exponent ||
        record.base.feed_exponent != preston.feed_exponent)
        value.set("pressure_exponent", record.base.pressure_exponent).set("feed_exponent", record.base.feed_exponent);
    if (record.wear.empty()) return value;
    Eigen::MatrixXd wear(record.wear.size(), 2);
    for (Eigen::Index i = 0; i < wear.rows(); ++i) wear.row(i) << record.wear[i].removed, record.wear[i].lost;
    return value.set("wear", wear).set("runs_without_wear", record.runs_without_wear);
}

LawRecord read_record(json::Reader reader)
{
    LawRecord record;
    record.pass_work = reader.number("pass_work", core::Range::positive());
    const Eigen::MatrixXd rows = reader.matrix("passes", kColumnCount);
    for (const auto& row : rows.rowwise())
        record.passes.push_back(read_row(row, reader, "passes", "pass " + std::to_string(record.passes.size() + 1)));
    if (record.passes.empty()) reader.refuse("passes", "is empty");
    read_parts(reader, record);
    record.base.pressure_exponent = reader.number_or("pressure_exponent", 1, core::Range::between(0, 5));
    record.base.feed_exponent = reader.number_or("feed_exponent", 0, core::Range::between(-5, 5));
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
