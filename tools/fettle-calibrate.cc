#include "belt/contact_wheel.h"
#include "belt/surfel.h"
#include "belt_calibrate/belt_run.h"
#include "belt_calibrate/wheel_law.h"
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
    const std::string& input = t.main_input("PASSES", "what was ground: rows of measured trials, CSV; or a trace, PCD, "
                                                      "of fettle-grind with --job, of fettle-belt with --wheel");
    const std::string& job = t.optional_file("--job", "JOB", "Of a gantry's trace: the operator's job, JSON");
    const std::string& wheel =
        t.optional_file("--wheel", "FILE", "Of a belt: its wheel, JSON, which is written with the law that was learnt");
    const std::string& before =
        t.optional_file("--before", "PART", "Of a trace: the part before, a mesh or a cloud; of a belt, its surfels");
    const std::string& after =
        t.optional_file("--after", "PART", "And after: required of a belt; of a gantry, for the machine's yielding");
    const std::optional<double>& cell =
        t.optional_number("--cell", "LENGTH", "Of a gantry's height maps [as fettle-grind]", core::Range::positive());
    const std::string& known = t.optional_file("--known", "FILE", "Learn on from this law, an output of this tool");
    const double& area =
        t.number("--area", 50, "MM2", "Of rows, with --wheel: contact while the wheel stands", core::Range::positive());
    const double& travel = t.number("--travel", 100, "MM", "Of rows, with --wheel: way of the belt in a revolution",
                                    core::Range::positive());

    void check() const
    {
        const bool has_trace = !before.empty();
        if (!job.empty() && !wheel.empty()) throw core::InputError("--job", "is of a gantry, --wheel of a belt");
        if (has_trace ? job.empty() && wheel.empty() : !job.empty())
            throw core::InputError(has_trace ? "--before" : "--job",
                                   has_trace ? "goes with --job or --wheel" : "goes with --before");
        if (!has_trace && !after.empty()) throw core::InputError("--after", "goes with --before");
        if (has_trace && !wheel.empty() && after.empty())
            throw core::InputError("--wheel", "and --before need --after, or nothing says what was removed");
        if (job.empty() && cell) throw core::InputError("--cell", "goes with --job and --before");
    }
};

/// What the input says: the passes, and what only traces tell.
struct Measurement {
    std::vector<removal::RemovalTrial> passes;
    double pass_work = 0;
    std::string machine; ///< gantry or belt: the name of `traced`; empty: rows
    json::Value traced;
    std::optional<belt::BeltLaw> wheel_law;
    std::vector<calibrate::WearInterval> wear; ///< of a gantry's wheel
    calibrate::TrialBase base;                 ///< of a belt's passes
};

Measurement measure_rows(const Options& o)
{
    Measurement rows;
    rows.passes = calibrate::read_trials(core::read_file(o.input), core::display_name(o.input)).exact;
    rows.pass_work = calibrate::typical_pass_work(rows.passes.front());
    return rows;
}

Measurement measure_gantry_trace(const Options& o)
{
    const job::Job job = job::read_job(o.job);
    job::Job ground = job;
    ground.sampling = job.anomaly; // The wheel is where B is: a stock as fettle-grind leaves it covers no more.
    const double cell = gantry::stock_cell_size(job, o.cell ? *o.cell * job.units.mm() : 0);
    const auto height_map = [&](const std::string& file) {
        const std::string name = core::display_name(file);
        const sampling::Scan part = sampling::read_scan(file, job, std::nullopt);
        for (const std::string& doubt : sampling::scan_warnings(part, ground, name)) o.t.warn(doubt);
        return removal::stock_from_scan(part, job, cell, name);
    };
    const auto trace = strategy::read_trace(o.input, job.units);
    const removal::HeightField before = height_map(o.before);
    std::optional<removal::HeightField> after;
    if (!o.after.empty()) after = height_map(o.after);
    const calibrate::GantryLaw law = calibrate::measure_gantry(trace, job, before, after);
    return {law.passes, law.pass_work, "gantry", calibrate::to_json(law), std::nullopt, law.wear, {}};
}

Measurement measure_belt_trace(const Options& o, const belt::ContactWheel& wheel)
{
    const cloud::Cloud trace = cloud::read_cloud(o.input).cloud;
    const belt::Surfels before = belt::read_surfels(o.before).surfels, after = belt::read_surfels(o.after).surfels;
    const belt_calibrate::BeltRunLaw law = cli::with_error_prefix(core::display_name(o.input), [&] {
        return belt_calibrate::measure_belt(trace, wheel, before, after, o.t.progress("fitting"));
    });
    return {law.passes,
            law.pass_work,
            "belt",
            belt_calibrate::to_json(law),
            law.law,
            {},
            {wheel.law.pressure_exponent, wheel.law.feed_exponent}};
}

/// The passes of the input, after those of the law that is known.
calibrate::LawRecord record_of(const Options& o, const Measurement& measured)
{
    calibrate::LawRecord record;
    record.pass_work = measured.pass_work;
    record.passes = measured.passes;
    record.base = measured.base;
    if (!o.known.empty())
        record = calibrate::continued(calibrate::read_law(o.known), record, core::display_name(o.input));
    if (measured.machine == "gantry") calibrate::add_wear(record, measured.wear);
    return record;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Learn the removal law of a machine from what it ground.\n"
        "Of a belt, from rows of trials: coefficient, and exponents of force, speed, feed and time, with the wear; "
        "from its trace and the surfels before and after: coefficient, and exponents of pressure and feed. Of a "
        "gantry, from its trace and the part before and after: Preston's coefficient, the exponent of the force, the "
        "tangential force, the spring, the grinding ratio, the machine's yielding. Out: the law with its covariance, "
        "how each part of it is "
        "determined, what could not be told apart, the pass that would tell most, and the passes, from which it can "
        "be learned on. Rows are taken in the order of the belt's work.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        t.example("fettle-calibrate removal/static.csv > law.json", "the law of a belt from 24 measured trials");
        t.reference("West & Harrison 1997, 4 and 12 (models in parallel); Meinhold & Singpurwalla 1989 (heavy tails); "
                    "Preston 1927");
        t.output_formats({"json"});
        t.parse();
        o.check();

        const std::string name = core::display_name(o.input);
        std::optional<belt::ContactWheel> wheel;
        if (!o.wheel.empty()) wheel = belt::read_contact_wheel(o.wheel);
        const Measurement measured = o.before.empty() ? measure_rows(o)
                                     : wheel          ? measure_belt_trace(o, *wheel)
                                                      : measure_gantry_trace(o);
        const calibrate::LawRecord record = record_of(o, measured);
        const calibrate::LearntLaw law = cli::with_error_prefix(name, [&] { return calibrate::learn(record); });
        for (std::size_t k = 0; k < law.passes.size(); ++k)
            if (law.passes[k].has_change) t.warn(name + ": " + calibrate::change_message(law.passes[k], k + 1));

        json::Value learnt = calibrate::to_json(law);
        if (!measured.machine.empty()) learnt.set(measured.machine, measured.traced);
        t.report() = learnt;
        learnt.set("record", calibrate::to_json(record));
        if (wheel) {
            wheel->law =
                measured.wheel_law ? *measured.wheel_law : belt_calibrate::belt_law(law, *wheel, o.area, o.travel);
            wheel->law_source = "fettle-calibrate";
            t.output() << belt::to_json(*wheel).set("learnt", learnt);
        } else {
            t.output() << calibrate::law_file(learnt);
        }
        return cli::Verdict::yes;
    });
}
