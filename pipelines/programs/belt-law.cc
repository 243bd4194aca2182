// The removal law of a belt from measured trials, and how well it predicts trials that it was not fitted to.

#include "belt/contact_wheel.h"
#include "calibrate/trials_csv.h"
#include "cli/tool.h"
#include "core/file.h"
#include "core/text.h"
#include "removal/removal_fit.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

using namespace fettle;

namespace {

/// Is the recorded work a state that trials hand on? How many trials there are with one that begins where they end,
/// within `kShareTolerance` of their own work, and how many by chance: where no belt ever ends.
json::Value work_carried(const std::vector<removal::RemovalTrial>& trials)
{
    constexpr double kShareTolerance = 0.02; // work was summed with set values; force, speed and duration are means
    const auto followed = [&](double share) {
        std::size_t count = 0;
        for (const removal::RemovalTrial& trial : trials) {
            const double own = trial.force * trial.speed * trial.duration;
            const auto follows = [&](const removal::RemovalTrial& other) {
                return std::abs((other.prior_work - trial.prior_work) / own - share) <= kShareTolerance;
            };
            count += std::any_of(trials.begin(), trials.end(), follows) ? 1 : 0;
        }
        return count;
    };
    return json::Value().set("handed_on", followed(1)).set("by_chance", followed(0.9)).set("trials", trials.size());
}

json::Value score_of(const char* name, const std::vector<removal::RemovalTrial>& trials,
                     const removal::RemovalTerms& terms)
{
    const removal::RemovalScore score = removal::score_removal(trials, terms);
    const removal::RemovalLaw& law = score.law;
    return json::Value()
        .set("name", name)
        .set("r2", score.r2)
        .set("left_out_r2", score.leave_one_out_r2)
        .set("worst_factor", score.worst_factor)
        .set("coefficient", std::exp(law.log_coefficient))
        .set("force", law.force_exponent)
        .set("speed", law.speed_exponent)
        .set("feed", law.feed_exponent)
        .set("duration", law.duration_exponent)
        .set("threshold", law.threshold)
        .set("wear_work", law.wear_rate > 0 ? 1 / law.wear_rate : 0);
}

/// As a wheel's file has it: pressure is force over `area`, mm²; the belt goes `travel` mm in a unit of the trials'
/// speed and a second.
json::Value wheels_law(const removal::RemovalLaw& law, double area, double travel)
{
    return json::Value()
        .set("type", "power")
        .set("coefficient", std::exp(law.log_coefficient) * std::pow(area, law.force_exponent - 1) *
                                std::pow(travel, -law.speed_exponent))
        .set("pressure_exponent", law.force_exponent)
        .set("speed_exponent", law.speed_exponent)
        .set("dwell_exponent", law.duration_exponent)
        .set("wear_work", law.wear_rate > 0 ? travel / law.wear_rate / belt::kNewtonMmPerJoule : 0);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Fit the removal law of a belt to measured trials, JSON.\n"
        "TRIALS has a row of names and the columns avg_force_N, initial_wear, removed_mm3 and grind_time_s and "
        "avg_rpm, or "
        "feed_rate_setpoint; with a column exact, rows where it is not 1 say bounds and are left out.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& path = t.main_input("TRIALS", "CSV");
        const double& area =
            t.number("--area", 50, "MM2", "Of the contact while the wheel stands", core::Range::positive());
        const double& travel = t.number("--travel", 100, "MM", "Of the belt in a revolution", core::Range::positive());
        t.parse();
        const std::string name = core::display_name(path);
        const auto [exact, all] = calibrate::read_trials(core::read_file(path), name);
        const std::vector<json::Value> laws = cli::with_error_prefix(name, [&] {
            return std::vector<json::Value>{score_of("Preston", exact, {false, false, false}),
                                            score_of("Preston, wear", exact, {false, true, false}),
                                            score_of("exponents", exact, {true, false, false}),
                                            score_of("exponents, wear", exact, {true, true, false}),
                                            score_of("exponents, wear, threshold", exact, {true, true, true})};
        });
        json::Value out;
        out.set("rows", all.size()).set("trials", exact.size()).set("laws", laws);
        const bool is_static = !exact.empty() && !std::isnan(exact.front().duration);
        if (is_static) {
            constexpr double kSeconds = 60; // in a minute
            out.set("work", work_carried(all))
                .set("law", wheels_law(removal::fit_removal(exact, {true, true, false}), area, travel / kSeconds));
        }
        t.output() << out;
        return cli::Verdict::yes;
    });
}
