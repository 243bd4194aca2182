#include "cli/screen.h"
#include "cli/tool.h"
#include "core/constants.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "job/job.h"
#include "station/station.h"

#include <csignal>
#include <optional>

using namespace fettle;

namespace {

/// Set by a signal that asks the program to end: it stops the machine first. A second signal ends it as ever.
volatile std::sig_atomic_t terminated = 0;

void end_on_signals()
{
    struct sigaction action = {};
    action.sa_handler = [](int) { terminated = 1; };
    action.sa_flags = int(SA_RESETHAND | SA_RESTART);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

struct Options {
    cli::Tool& t;
    const std::string& job = t.positional_file(
        "JOB", "The settings, and the boundaries where none are shown: any job of this machine, JSON");
    const std::string& folder = t.required_text(
        "--session", "FOLDER", "Where all is kept, as soon as it is known: points, touches, surface, plan, traces");
    const bool& resume =
        t.flag("--resume", "Go on with the session in that folder, if there is one, whatever ended it");
    gantry::GantryOptions gantry{
        t,
        {.fallback = "", .gantry = "The machine: a simulated gantry, one with drives, or a driver (docs/driver.md)"}};
    gantry::StockOptions stock{t, "beneath a virtual gantry; of a driver's machine if it is known"};
    const double& removal_factor = gantry::declare_removal_factor(t);
    const std::string& steering = t.optional_file(
        "--steer", "EVENTS",
        "The operator: the keys of a terminal, a joystick's device, or a file or pipe of lines (docs/formats.md) "
        "[/dev/tty]");
    const std::string& joystick = t.optional_file("--joystick", "DEVICE", "A joystick beside the keys of the terminal");
    const std::string& surface =
        t.choice("--surface", "", job::kSurfaceTypes, "Type of the desired surface; default: as in JOB");
    const std::optional<double>& direction =
        t.optional_number("--direction", "DEG", "Direction of the rulings of a swept surface, from X_w");
    const std::optional<double>& theta = t.optional_number(
        "--theta", "DEG", "Direction of the wheel's axis at the beginning, counter-clockwise from X_m");
    const gantry::TouchStrategy& touches =
        t.choice<gantry::TouchStrategy>("--strategy",
                                        {{"extended", gantry::TouchStrategy::extended},
                                         {"wang", gantry::TouchStrategy::wang},
                                         {"adaptive", gantry::TouchStrategy::adaptive}},
                                        "How the touches are chosen, as by fettle-sample");
    const double& confidence = t.number("--confidence", 0.99, "SHARE", "Of the margin, as of fettle-margin",
                                        core::Range::strictly_between(0, 1));
    const strategy::Layer1& layer_1 = t.choice<strategy::Layer1>("--layer-1",
                                                                 {{"constant", strategy::Layer1::constant},
                                                                  {"feed", strategy::Layer1::feed},
                                                                  {"force", strategy::Layer1::force}},
                                                                 "How layer 1 is ground, as by fettle-grind");
    const std::optional<double>& force = t.optional_number(
        "--force", "FORCE", "To be held in manual mode; default: the job's F_down", core::Range::positive());
    const std::optional<double>& lowest =
        t.optional_number("--lowest", "Z", "Lower bound of probe and drives; default: that of the machine");
    const std::optional<double>& pace = t.optional_number(
        "--pace", "FACTOR",
        "Time of a simulated machine over real time; 0: as fast as it is computed [1 with keys or a joystick, else 0]",
        core::Range::at_least(0));
    const bool& ascii = t.flag("--ascii", "Write PCDs as text");
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-station jobs/wang1.json --session session --gantry virtual --stock <(fettle-part "
              "parts/wang1.json) --steer steering/session.txt --report report.json",
              "the H of Wang's part 1 shown, touched, ground, stopped in the middle, and ended");
    t.reference("Wang 2007, 3 and 6.1.1: what the operator does, and the modes");
    t.disable_output();
}

job::Job settings(const Options& o)
{
    job::Job job = job::read_job(o.job);
    if (o.theta) job.theta = *o.theta * core::kRadPerDegree;
    if (!o.surface.empty()) job.surface = job::parse_surface_type(o.surface);
    if (o.direction && job.surface != job::SurfaceType::swept)
        throw core::InputError("--direction", "goes with a swept surface alone");
    if (o.direction) job.ruling_direction = *o.direction * core::kRadPerDegree;
    return job::validated(job, core::display_name(o.job));
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description = "Lead an operator through one job on a gantry: show, touch, judge, grind, stop.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        o.gantry.check();

        const job::Job job = settings(o);
        strategy::Steering steering(o.steering.empty() ? "/dev/tty" : o.steering, o.joystick);
        const bool is_live = !steering.next_change();
        station::StationOptions options{.workplace = {o.gantry, o.stock, o.removal_factor, t.seed()},
                                        .planning = {o.touches, o.confidence, t.seed(), cloud::pcd_encoding(o.ascii)},
                                        .folder = o.folder,
                                        .resume = o.resume,
                                        .layer_1 = o.layer_1,
                                        .encoding = cloud::pcd_encoding(o.ascii),
                                        .force = {},
                                        .lowest = {},
                                        .show = {},
                                        .is_terminated = [] { return terminated != 0; }};
        if (o.force) options.force = *o.force * job.units.newton();
        if (o.lowest) options.lowest = *o.lowest * job.units.mm();
        options.pace = o.pace.value_or(is_live ? 1 : 0);
        end_on_signals();
        station::StationResult result;
        {
            const cli::TerminalScreen screen(t.shows_progress());
            if (screen.is_shown()) options.show = [&](const auto& lines) { screen.show(lines); };
            result = station::run_station(job, steering, options);
        }
        for (const std::string& warning : result.warnings) t.warn(warning);
        if (!result.failure.empty()) t.fault(result.failure);
        t.report() = result.report;
        return result.is_complete ? cli::Verdict::yes : cli::Verdict::no;
    });
}
