#include "belt/belt_journal.h"
#include "belt/belt_options.h"
#include "belt/belt_report.h"
#include "belt/belt_watch.h"
#include "belt/stock_frames.h"
#include "belt_calibrate/belt_learning.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "draw/figures.h"

#include <algorithm>

using namespace fettle;

namespace {

/// What happens along the path: the parameters of the run and the files that are kept up meanwhile.
struct Options {
    belt::GrindingOptions grinding;
    const belt::BeltModel& model;
    belt::ContactOptions contact;
    const std::string& trace;
    const std::string& watch;
    const std::optional<double>&lower, &upper;
    const std::string& journal;
    const double& journal_interval;
    const std::string& learn;
    const std::string& actual;
    draw::Frames frames;
};

Options declare_options(cli::Tool& t)
{
    using enum belt::BeltModel;
    return {
        belt::GrindingOptions(t),
        t.choice<belt::BeltModel>(
            "--model", {{"local", local}, {"global", global}},
            "The force acts as the contact's pressure, or evenly over the contact's rectangle (Hammann 1998)"),
        belt::ContactOptions(t, 32, 1e-4),
        t.optional_output("--trace", "The path with what happened at each point", cloud::cloud_formats()),
        t.text("--watch", "", "FILE",
               "The errors after each point, CSV, line by line as they come; with --lower and --upper"),
        t.optional_number("--lower", "LENGTH", "For --watch: less is left on gouged surfels"),
        t.optional_number("--upper", "LENGTH", "For --watch: more is left on undercut ones"),
        t.text("--journal", "", "FILE",
               "Checkpoints of the run; where it is there already, from a run that was killed, the run goes on"),
        t.number("--journal-every", belt::BeltJournal{}.interval, "S", "Work that may be lost",
                 core::Range::at_least(0)),
        t.text(
            "--learn", "", "LAW",
            "The belt's law, learnt pass by pass: read if it is there, and written anew as a wheel; feeds are changed "
            "to remove what the path was planned for"),
        t.optional_file("--actual", "FILE", "The wheel with the law that the belt has in truth, JSON [--wheel]"),
        draw::Frames(t)};
}

void check(const Options& options)
{
    options.grinding.check();
    options.contact.check();
    options.frames.check_folder();
    const bool has_lower = options.lower.has_value(), has_upper = options.upper.has_value();
    if (has_lower == options.watch.empty() || has_upper == options.watch.empty())
        throw core::InputError("--watch", "goes with --lower and --upper");
    if (has_lower && !(*options.lower <= *options.upper)) throw core::InputError("--lower", "is more than --upper");
}

belt::BeltOptions belt_options(const Options& given, double mm)
{
    belt::BeltOptions options;
    options.contact = given.contact.values();
    options.model = given.model;
    options.prior_work = given.grinding.prior_work();
    if (given.lower) options.range = {*given.lower * mm, *given.upper * mm};
    return options;
}

belt::BeltRun grind(cli::Tool& t, Options& given, const belt::BeltOptions& options, belt::Surfels& surfels,
                    const belt::ContactWheel& wheel, const std::vector<belt::BeltPoint>& path, double mm,
                    const std::string& path_file, belt_calibrate::BeltLearning* learning)
{
    std::optional<belt::BeltErrorLog> log;
    if (given.lower) log.emplace(given.watch, mm);
    std::optional<belt::SurfelPictures> pictures;
    if (given.frames.wanted()) pictures.emplace(surfels, options.range);
    const std::vector<std::size_t> frame_steps = given.frames.steps(path.size());
    const auto listener = [&](const belt::BeltRun& run) {
        if (log) log->write(run);
        const std::size_t point = run.trace.size() - 1;
        if (pictures && std::ranges::binary_search(frame_steps, point))
            given.frames.add(run.trace.back().time,
                             pictures->picture(surfels, draw::duration_text(run.trace.back().time) + ", point " +
                                                            std::to_string(point + 1) + " of " +
                                                            std::to_string(path.size())));
    };
    const belt::BeltJournal journal{given.journal, given.journal_interval,
                                    learning ? learning->context_digest() : std::string()};
    try {
        return belt::grind(surfels, wheel, path, options, journal, listener, learning, t.progress("grinding"));
    } catch (const core::InputError& error) { // about a point of the path
        if (!std::string(error.what()).starts_with("point ")) throw;
        throw core::InputError(core::display_name(path_file), error.what());
    }
}

/// The wheel as it is in truth: its law may be another one than that for which the path was planned.
belt::ContactWheel actual_wheel(const Options& options, belt::ContactWheel wheel)
{
    if (!options.actual.empty()) wheel.law = belt::read_contact_wheel(options.actual).law;
    return wheel;
}

/// Hands the law on, and warns of the passes that it does not explain.
void write_law(cli::Tool& t, const Options& options, const std::string& path_file,
               const belt_calibrate::BeltLearning& learning)
{
    for (const std::string& line : learning.warnings()) t.warn(core::display_name(path_file) + ": " + line);
    t.report().set("learnt", learning.report());
    if (learning.is_informed()) t.output_file(options.learn) << learning.file();
}

void write_surfels(const cloud::CloudOutput& out, belt::SurfelFile& ground, Eigen::VectorXd removed)
{
    cloud::Cloud& cloud = ground.file.cloud;
    if (cloud::has_field(cloud, "removed")) removed += cloud::field(cloud, "removed");
    cloud::set_field(cloud, "displacement", ground.surfels.displacement, 8);
    cloud::set_field(cloud, "removed", removed, 8);
    out.write(cloud, ground.file.units);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Grind surfels along a path with a belt over an elastic contact wheel.\n"
        "At each point of the path the wheel is pressed on, by its force or its depth (fields of the path, or options "
        "that hold for all points), the pressure follows from the contact (fettle-contact), and the surfels that touch "
        "lose depth by the wheel's law, during the time for half the distance to each of the next points of the same "
        "run. The others stay as they are. A point of NaN, or another pass, ends a run: the wheel is off the part. "
        "Out: the surfels with their new displacement, and removed, which is added up from belt to belt.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& points = t.main_input("SURFELS", "points with normals (fettle-surfel), PCD or PLY");
        const std::string& path_file =
            t.required_file_option("--path", "FILE", "Contact points with poses, PCD (fettle-path)");
        const std::string& wheel_file = t.required_file_option("--wheel", "FILE", "The wheel, JSON");
        const auto& unit = t.length_unit("--file-units", "Unit of SURFELS, and of lengths here [its header, or mm]");
        Options options = declare_options(t);
        const cloud::CloudOutput out{t};
        t.example(
            "fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 | "
            "fettle-belt --path paths/keel.pcd --wheel wheels/rubber.json --force 20 --report belt.json > ground.pcd",
            "20 N along the keel");
        t.reference("Ren et al. 2006, eq. 5; Hammann 1998");
        t.parse();

        check(options);
        for (const std::string& kept : {options.watch, options.journal})
            if (!kept.empty()) t.reserve_output(kept);
        belt::SurfelFile ground = belt::read_surfels(points, unit);
        const units::Units units = ground.file.units;
        const belt::ContactWheel wheel = belt::read_contact_wheel(wheel_file);
        cloud::CloudFile path = cloud::read_cloud(path_file);
        auto belt_points = cli::with_error_prefix(core::display_name(path_file), [&] {
            return belt::belt_path(path.cloud, options.grinding.settings(units.mm()));
        });
        const belt::BeltOptions belt_options = ::belt_options(options, units.mm());
        std::optional<belt_calibrate::BeltLearning> learning;
        if (!options.learn.empty()) {
            core::OutputFile{options.learn}; // where it cannot be written, that is said before the part is ground
            learning.emplace(options.learn, wheel, belt_options, ground.surfels, belt_points);
        }
        belt::BeltRun run = grind(t, options, belt_options, ground.surfels, actual_wheel(options, wheel), belt_points,
                                  units.mm(), path_file, learning ? &*learning : nullptr);

        if (!options.trace.empty()) {
            if (learning) belt::set_feeds(path.cloud, belt_points);
            belt::set_trace(path.cloud, run.trace);
            out.write(options.trace, path.cloud, path.units);
        }
        write_surfels(out, ground, run.removed);
        options.frames.finish("The surfels while they are ground.");
        t.report() = belt::to_json(run, out.units(units));
        if (learning) write_law(t, options, path_file, *learning);
        if (const std::string doubt = belt::edge_warning(run.near_edge, options.contact.values()); !doubt.empty())
            t.warn(doubt);
        if (const std::string doubt = belt::coarse_grid_warning(run, options.contact.cells); !doubt.empty())
            t.warn(doubt);
        return cli::Verdict::yes;
    });
}
