#include "cli/questions.h"
#include "cli/tool.h"
#include "core/constants.h"
#include "core/file.h"
#include "core/text.h"
#include "gantry/gantry_options.h"
#include "gantry/make_virtual.h"
#include "job/boundary.h"
#include "job/frame.h"
#include "job/job.h"
#include "job/picked.h"
#include "sampling/scan.h"
#include "strategy/teach.h"
#include "json/units.h"

#include <cmath>
#include <optional>
#include <ostream>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& job =
        t.positional_file("JOB", "Settings to start from: any job, JSON; its boundaries are replaced");
    const std::string& anomaly =
        t.optional_file("--anomaly", "POINTS",
                        "Around the anomaly, picked in CloudCompare, pcd_viewer or a page of fettle-view --pick: "
                        "their text. A page's list may hold both boundaries");
    const std::string& sampling = t.optional_file("--sampling", "POINTS", "Around the area that may be touched");
    const std::optional<units::Units::Length>& file_units =
        t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
    const std::string& on = t.optional_file("--on", "SCAN", "Of points without z: the part whose height they get");
    const std::optional<units::Units::Length>& on_units =
        t.length_unit("--on-units", "Unit of SCAN, if it is not the job's");
    gantry::GantryOptions gantry{
        t,
        {.fallback = "",
         .gantry = "Instead of --anomaly: the points are shown on a machine, a simulated gantry, one with drives, or a "
                   "driver (docs/driver.md). Settings that are not given are asked for on stdin"}};
    const std::string& stock =
        t.optional_file("--stock", "PART", "The part beneath a virtual gantry: STL, PLY, OBJ or PCD");
    const std::optional<units::Units::Length>& stock_units =
        t.length_unit("--stock-units", "Unit of PART, if it is not the job's");
    const std::string& steering = t.optional_file(
        "--steer", "EVENTS",
        "The operator's joystick: its device (button 2: record, 3: next), the keys of /dev/tty, or a file or pipe of "
        "lines (docs/formats.md); -: stdin, and nothing is asked");
    const std::optional<double>& lowest =
        t.optional_number("--lowest", "Z", "Lower bound of the probe's z; default: that of the machine");
    const std::string& surface =
        t.choice("--surface", "", job::kSurfaceTypes, "Type of the desired surface; default: as in JOB");
    const std::optional<double>& direction =
        t.optional_number("--direction", "DEG", "Direction of the rulings of a swept surface, from X_w");
    const std::optional<double>& theta =
        t.optional_number("--theta", "DEG", "Direction of the wheel's axis, counter-clockwise from X_m");
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-teach jobs/wang1.json --gantry virtual --stock <(fettle-part parts/wang1.json) "
              "--steer steering/teach.txt",
              "eight points around the H of Wang's part 1, shown on a simulated gantry");
    t.reference("Wang 2007, 3 and 6.1.1: what the operator teaches");
}

void check(const Options& o)
{
    const bool on_gantry = !o.gantry.kind.empty();
    if (on_gantry != o.anomaly.empty()) throw core::InputError("--anomaly", "or --gantry must be given, not both");
    if (on_gantry) {
        o.gantry.check();
        if (o.gantry.has_driver() != o.stock.empty())
            throw core::InputError("--stock", "goes with a virtual gantry, and that with it");
        if (o.steering.empty()) throw core::InputError("--steer", "goes with --gantry");
    }
    if (on_gantry && (!o.sampling.empty() || o.file_units || !o.on.empty()))
        throw core::InputError("--sampling, --file-units, --on: go with --anomaly");
}

/// Sets surface and θ by the options, or else by the operator's answers. @param answers  null: nobody is asked
void apply_settings(job::Job& job, const Options& o, cli::OperatorPrompt* answers)
{
    const auto angle = [&](const std::optional<double>& option, const char* question, double fallback) {
        if (option) return *option * core::kRadPerDegree;
        if (answers == nullptr) return fallback;
        return answers->ask_number(question, fallback / core::kRadPerDegree) * core::kRadPerDegree;
    };
    job.theta = angle(o.theta, "θ of the wheel's axis, degrees", job.theta);
    if (!o.surface.empty())
        job.surface = job::parse_surface_type(o.surface);
    else if (answers != nullptr)
        job.surface =
            job::parse_surface_type(answers->ask_choice("Surface", job::kSurfaceTypes, job::to_string(job.surface)));
    if (job.surface == job::SurfaceType::swept)
        job.ruling_direction = angle(o.direction, "Rulings, degrees from the wheel's axis", job.ruling_direction);
    else if (o.direction)
        throw core::InputError("--direction", "goes with a swept surface alone");
}

/// Sets the heights of points without z to those of the part, which is read, and so refused, even where none is
/// without.
void set_heights(cli::Tool& t, Eigen::Matrix3Xd& points, const job::Job& job, const Options& o)
{
    const sampling::Scan scan = sampling::read_scan(o.on, job, o.on_units);
    const std::string left_out = mesh::repair_warning(scan.repair());
    if (!left_out.empty()) t.warn(core::display_name(o.on) + ": " + left_out);
    if (points.row(2).allFinite()) return;
    if (job.T_part_job)
        throw core::InputError("--on", "a job with a frame of its own needs points with z: its z is not the part's");
    for (auto point : points.colwise()) {
        if (std::isfinite(point.z())) continue;
        const std::optional<double> height = scan.height(point.head<2>());
        if (!height)
            throw core::InputError(core::display_name(o.on),
                                   "has no surface at " + job::point_text(point.head<2>(), job.units));
        point.z() = *height;
    }
}

void set_picked_points(cli::Tool& t, job::Job& job, const Options& o, bool was_plane)
{
    const double mm = units::mm_per(o.file_units.value_or(job.units.length));
    const std::string list = core::read_file(o.anomaly);              // once: it may be a pipe
    const auto picked = [&](const std::string& path, char boundary) { // in the part's frame
        cloud::Cloud points;
        const job::WantedPicks wanted{boundary, !o.on.empty()};
        points.xyz = mm * (path == o.anomaly ? job::parse_picked_points(list, core::display_name(path), wanted)
                                             : job::read_picked_points(path, wanted));
        if (!o.on.empty()) set_heights(t, points.xyz, job, o);
        job::move_to_job_frame(points, job);
        return points.xyz;
    };
    const bool has_both = o.sampling.empty() && job::holds_both_boundaries(list);
    job.anomaly = picked(o.anomaly, 'B');
    if (has_both || !o.sampling.empty())
        job.sampling = picked(has_both ? o.anomaly : o.sampling, 'S');
    else if (was_plane && job.surface == job::SurfaceType::plane)
        job.sampling.resize(3, 0); // it is optional for a plane, and the old one is about another place
}

/// Lets the operator record the boundary points on a machine; prints each point.
void teach_on_gantry(cli::Tool& t, const Options& o, const cli::OperatorPrompt& prompt, job::Job& job)
{
    strategy::Steering steering(o.steering);
    removal::HeightField stock;
    if (!o.stock.empty())
        stock = removal::stock_over_scan(sampling::read_scan(o.stock, job, o.stock_units), job.theta,
                                         gantry::stock_cell_size(job, 0));
    const auto [machine, limits, simulated] = gantry::open_gantry(o.gantry, job, stock, t.seed());
    const double mm = job.units.mm();
    int missed = 0;
    const auto recorded = [&](const char* boundary, Eigen::Index number, const Eigen::Vector3d& point) {
        const bool touched = !std::isnan(point.z());
        if (!touched) ++missed;
        const std::string z = core::to_short_text(point.z() / mm);
        if (point.z() >= job.safe_height)
            throw core::InputError("safe_height " + core::to_short_text(job.safe_height / mm) +
                                   " is not above the touch at z " + z);
        const std::string text = std::string(boundary) + " " + std::to_string(number) + ": " +
                                 job::point_text(point.head<2>(), job.units) + ", " +
                                 (touched ? "z " + z : "no surface");
        prompt.print_hint(text + "\n");
        t.note(text);
    };
    prompt.print_hint("Steer; record points around the anomaly, next, points around what may be touched, next.\n");
    const double lowest = o.lowest ? *o.lowest * mm : limits.min.z();
    strategy::TaughtBoundaries taught = strategy::teach_boundaries(job, *machine, limits, steering, lowest, recorded);
    job.anomaly = std::move(taught.anomaly);
    job.sampling = std::move(taught.sampling);
    if (missed > 0)
        t.warn(std::to_string(missed) + (missed == 1 ? " point" : " points") + " found no surface: recorded without z");
    t.report().set("touches_without_surface", missed).set("machine_time", machine->status().time);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description = "Make a job from points shown on a gantry, or picked on a scan.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.output_formats({"json"});
        t.parse();
        check(o);

        job::Job job = job::read_job(o.job);
        t.report().set("kind", "teach").set("units", json::to_json(job.units.length));
        std::optional<cli::OperatorPrompt> prompt;
        if (!o.gantry.kind.empty()) prompt.emplace(o.steering != "-");
        const bool was_plane = job.surface == job::SurfaceType::plane;
        apply_settings(job, o, prompt ? &*prompt : nullptr); // first: the head turns to θ before anything is touched
        if (prompt) {
            teach_on_gantry(t, o, *prompt, job);
        } else {
            set_picked_points(t, job, o, was_plane);
        }
        const job::Job taught = job::validated(job, "the job that was taught");
        job::add_report(t.report(), taught);
        if (prompt && prompt->ask_choice("Write the job", {"start", "stop"}, "start") == "stop")
            throw core::InputError("stopped by the operator: no job is made");
        t.output() << job::to_json(taught);
        return cli::Verdict::yes;
    });
}
