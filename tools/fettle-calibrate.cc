#include "belt/contact_wheel.h"
#include "calibrate/gantry_passes.h"
#include "calibrate/law_file.h"
#include "calibrate/law_report.h"
#include "calibrate/trials_csv.h"
#include "cli/tool.h"
#include "core/file.h"
#include "gantry/make_virtual.h"
#include "job/job.h"
#include "sampling/scan.h"
#include "strategy/trace_file.h"

#include <ostream>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& input = t.main_input("PASSES", "what was ground: rows of measured trials, CSV; or the trace of "
                                                      "fettle-grind, PCD, with --job");
    const std::string& job = t.optional_file("--job", "JOB", "Of the trace: the operator's job, JSON");
    const std::string& before = t.optional_file("--before", "PART", "Of the trace: the part before, a mesh or a cloud");
    const std::string& after =
        t.optional_file("--after", "PART", "And after: then wheel loss and yielding are measured, too");
    const std::optional<double>& cell =
        t.optional_number("--cell", "LENGTH", "Of the height maps [as fettle-grind]", core::Range::positive());
    const std::string& known = t.optional_file("--known", "LAW", "Learn on from this law, an output of this tool");
    const std::string& wheel = t.optional_file("--wheel", "WHEEL", "Write this belt's wheel with the law of the rows");
    const double& area =
        t.number("--area", 50, "MM2", "Of the contact while the wheel stands, for --wheel", core::Range::positive());
    const double& travel =
        t.number("--travel", 100, "MM", "Of the belt in a revolution, for --wheel", core::Range::positive());

    void check() const
    {
        if (job.empty() != before.empty()) throw core::InputError("--job", "goes with --before");
        if (job.empty() && !after.empty()) throw core::InputError("--after", "goes with --job and --before");
        if (job.empty() && cell) throw core::InputError("--cell", "goes with --job and --before");
        if (!job.empty() && !wheel.empty()) throw core::InputError("--wheel", "is of a belt, --job of a gantry");
    }
};

removal::HeightField height_map(const Options& o, const std::string& file, const job::Job& job)
{
    const double cell = gantry::stock_cell_size(job, o.cell ? *o.cell * job.units.mm() : 0);
    return removal::stock_from_scan(sampling::read_scan(file, job, std::nullopt), job, cell, core::display_name(file));
}

/// The passes of the input, after those of the law that is known.
calibrate::LawRecord record_of(const Options& o, const std::vector<belt::RemovalTrial>& passes, double pass_work)
{
    if (o.known.empty()) return {pass_work, passes};
    return calibrate::continued(calibrate::read_law(o.known), passes, core::display_name(o.input));
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Learn the removal law of a machine from what it ground.\n"
        "Of a belt, from rows of trials: coefficient, and exponents of force, speed, feed and time, with the wear. Of "
        "a "
        "gantry, from its trace and the part before and after: Preston's coefficient, the exponent of the force, the "
        "spring, the wheel's loss, the machine's yielding. Out: the law with its covariance, how each part of it is "
        "determined, what could not be told apart, the pass that would tell most, and the passes, from which it can be "
        "learned on. Rows are taken in the order of the belt's work.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-calibrate removal/static.csv > law.json", "the law of a belt from 24 measured trials");
        t.reference("West & Harrison 1997, 4 and 12 (models in parallel); Meinhold & Singpurwalla 1989 (heavy tails); "
                    "Preston 1927");
        t.parse();
        o.check();

        const std::string name = core::display_name(o.input);
        std::optional<calibrate::GantryLaw> gantry;
        calibrate::LawRecord record;
        if (o.job.empty()) {
            const auto trials = calibrate::read_trials(core::read_file(o.input), name).exact;
            record = record_of(o, trials, calibrate::typical_pass_work(trials.front()));
        } else {
            const job::Job job = job::read_job(o.job);
            const auto trace = strategy::read_trace(o.input, job.units);
            const removal::HeightField before = height_map(o, o.before, job);
            std::optional<removal::HeightField> after;
            if (!o.after.empty()) after = height_map(o, o.after, job);
            gantry = cli::with_error_prefix(name, [&] { return calibrate::measure_gantry(trace, job, before, after); });
            record = record_of(o, gantry->passes, gantry->pass_work);
        }
        const calibrate::LearntLaw law = cli::with_error_prefix(name, [&] { return calibrate::learn(record); });
        for (std::size_t k = 0; k < law.passes.size(); ++k)
            if (law.passes[k].has_change) t.warn(name + ": " + calibrate::change_message(law.passes[k], k + 1));

        json::Value learnt = calibrate::to_json(law);
        if (gantry) learnt.set("gantry", calibrate::to_json(*gantry));
        t.report() = learnt;
        learnt.set("record", calibrate::to_json(record));
        if (o.wheel.empty()) {
            t.output() << calibrate::law_file(learnt);
        } else {
            belt::ContactWheel wheel = belt::read_contact_wheel(o.wheel);
            wheel.law = calibrate::belt_law(law, wheel, o.area, o.travel);
            t.output() << belt::to_json(wheel).set("learnt", learnt);
        }
        return cli::Verdict::yes;
    });
}
