#pragma once

#include "calibrate/gantry_passes.h"
#include "calibrate/law_belief.h"
#include "json/document.h"

#include <string>
#include <vector>

namespace fettle::calibrate {

/// The exponents of the law that a belt's trials along a path are relative to (belt_calibrate/belt_run.h).
struct TrialBase {
    double pressure_exponent = 1, feed_exponent = 0;
};

/// A trial relative to another base.
removal::RemovalTrial rebased(removal::RemovalTrial trial, const TrialBase& from, const TrialBase& to);

/// Trial of one part of a pass, whose conditions varied.
struct PartTrial {
    std::size_t pass; ///< index in the record
    removal::RemovalTrial trial;
};

/// The passes from which a law is learned, in their order: what is known follows from them alone, so that a belief is
/// handed from part to part as the list of its passes. Later passes must record what the first one does.
struct LawRecord {
    double pass_work = 0; ///< as in LawBelief
    std::vector<removal::RemovalTrial> passes;
    std::vector<WearInterval> wear; ///< of a gantry's wheel, the last ones
    int runs_without_wear = 0;      ///< the runs since then, in which the wheel was not measured twice
    std::vector<PartTrial> parts;   ///< ordered by pass; they are learned from in place of their pass
    TrialBase base;
};

/// A pass beside what was expected of it.
struct JudgedPass {
    removal::RemovalTrial pass;
    std::vector<removal::RemovalTrial> parts; ///< none: its conditions were the same all along
    Prediction predicted;
    bool is_judged = false;  ///< enough passes were known before
    bool has_change = false; ///< the law does not explain the pass
};

/// A law as the passes of a record teach it.
struct LearntLaw {
    LawBelief belief;
    std::vector<JudgedPass> passes;
};

/// Passes that are learned from before the first one is judged.
inline constexpr std::size_t kFirstJudged = 5;

/// Learns from one more pass: predicts, compares, updates. A pass whose volume has a two-sided probability of tail
/// below 1/300 has a change; then the level is loosened (LawBelief::loosen_level). It is judged as a whole, and learned
/// from part by part.
/// @throws InputError for a wrong value
void learn_pass(LearntLaw& law, const removal::RemovalTrial& pass,
                const std::vector<removal::RemovalTrial>& parts = {});
/// Learns pass by pass.
/// @throws InputError for no pass, and naming the pass that has a wrong value
LearntLaw learn(const LawRecord& record);

/// Adds what a run told of the wheel's wear; only the last intervals are kept, since wheels change.
void add_wear(LawRecord& record, const std::vector<WearInterval>& run);

/// The pass after those of a record, at their mean force and feed; its volume is unknown.
removal::RemovalTrial next_pass(const LawRecord& record);

/// What a pass removed of what was expected, for a message: "pass 12 took 3.1 mm³, expected 5.9 to 6.6: …".
std::string change_message(const JudgedPass& pass, std::size_t number);

/// The members pass_work and passes; wear and runs_without_wear if the wheel was measured; parts if there are some,
/// with the number of the pass first and the deviation last; the base unless it is Preston's law. 0 stands for what was
/// not recorded.
json::Value to_json(const LawRecord& record);
/// @throws InputError naming the key
LawRecord read_record(json::Reader reader);

} // namespace fettle::calibrate
