#include "belt/belt_journal.h"
#include "belt/belt_watch.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"

#include <cmath>
#include <ostream>

using namespace fettle;

namespace {

void set_trace(Cloud& cloud, const BeltRun& run)
{
    const auto add = [&](const char* name, double BeltTrace::*member) {
        Eigen::VectorXd values(cloud.size());
        for (Eigen::Index i = 0; i < cloud.size(); ++i) values[i] = run.trace[static_cast<std::size_t>(i)].*member;
        set_field(cloud, name, values, 8);
    };
    add("t", &BeltTrace::time);
    add("force", &BeltTrace::force);
    add("indentation", &BeltTrace::indentation);
    add("pressure", &BeltTrace::peak_pressure);
    add("area", &BeltTrace::area);
    add("removed_volume", &BeltTrace::removed);
}

void report(json::Value& out, const BeltRun& run, const Surfels& surfels, double mm)
{
    double force = 0, peak = 0, area = 0;
    for (const BeltTrace& at : run.trace)
        if (!std::isnan(at.force)) {
            force = std::max(force, at.force);
            peak = std::max(peak, at.peak_pressure);
            area = std::max(area, at.area);
        }
    out.set("points", run.trace.size())
        .set("time", run.trace.empty() ? 0 : run.trace.back().time)
        .set("removed_volume", run.removed_volume / (mm * mm * mm))
        .set("work", run.work / kJoule)
        .set("touched", static_cast<std::size_t>((run.removed.array() > 0).count()))
        .set("surfels", static_cast<std::size_t>(surfels.size()))
        .set("deepest", run.removed.maxCoeff() / mm)
        .set("max_force", force)
        .set("peak_pressure", peak)
        .set("max_area", area / (mm * mm))
        .set("near_edge", static_cast<std::size_t>(run.near_edge));
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Grind surfels along a path with a belt over an elastic contact wheel.\n"
        "At each point of the path the wheel is pressed on, by its force or its depth (fields of the path, or options "
        "that hold for all points), the pressure follows from the contact (fettle-contact), and the surfels that touch "
        "lose depth by the wheel's law, in the time that half the ways to the next points of the same run "
        "take. The others stay as they are. A point of NaN, or another pass, ends a run: the wheel is off the part. "
        "Out: the surfels with their new displacement, and "
        "removed, which is added up from belt to belt.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& points = t.input("SURFELS", "points with normals (fettle-surfel), PCD or PLY");
        const std::string& path_file =
            t.required_file("--path", "FILE", "Contact points with poses, PCD (fettle-path)");
        const std::string& wheel_file = t.required_file("--wheel", "FILE", "The wheel, JSON");
        const auto& unit = t.length_unit("--file-units", "Unit of SURFELS, and of lengths here [its header, or mm]");
        const auto& force = t.number_if_given("--force", "FORCE", "At all points, N", Range::positive());
        const auto& depth = t.number_if_given("--depth", "LENGTH", "Indentation at all points", Range::positive());
        const auto& feed =
            t.number_if_given("--feed", "LENGTH/S", "Where the path has no field feed [20 mm/s]", Range::positive());
        const double& dwell = t.number("--dwell", 0, "S", "At both ends of each run, besides", Range::at_least(0));
        const double& worn =
            t.number("--worn", 0, "J", "Work that the belt has done before (report: work)", Range::at_least(0));
        const std::string& model =
            t.choice("--model", "local", {"local", "global"},
                     "The force acts as the contact's pressure, or evenly over the contact's rectangle (Hammann 1998)");
        const std::string& gridding = t.choice("--gridding", "kriging", {"kriging", "shepard"}, "As of fettle-contact");
        const int& cells = t.count("--cells", 32, "As of fettle-contact", 8, 512);
        const double& tolerance = t.number("--tolerance", 1e-4, "SHARE", "As of fettle-contact", {1e-9, 1e-2});
        const std::string& trace = t.other_output("--trace", "The path with what happened at each point, PCD");
        const std::string& watch =
            t.text("--watch", "", "FILE",
                   "The errors after each point, CSV, line by line as they come; with --lower and --upper");
        const auto& lower = t.number_if_given("--lower", "LENGTH", "For --watch: less is left on gouged surfels");
        const auto& upper = t.number_if_given("--upper", "LENGTH", "For --watch: more is left on undercut ones");
        BeltJournal journal;
        const std::string& journal_file =
            t.text("--journal", "", "FILE",
                   "Kept up while grinding; where it is there already, from a run that was killed, the run goes on");
        const double& every =
            t.number("--journal-every", journal.every, "S", "Work that may be lost", Range::at_least(0));
        const bool& ascii = t.flag("--ascii", "Write PCDs as text");
        t.example(
            "fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 | "
            "fettle-belt --path paths/keel.pcd --wheel wheels/rubber.json --force 20 --report belt.json > ground.pcd",
            "20 N along the keel");
        t.reference("Ren et al. 2006, eq. 5; Hammann 1998");
        t.parse();

        if (force && depth) throw InputError("--force", "and --depth: one of them says how the wheel is pressed on");
        if (lower.has_value() == watch.empty() || upper.has_value() == watch.empty())
            throw InputError("--watch", "goes with --lower and --upper");
        if (lower && !(*lower <= *upper)) throw InputError("--lower", "is more than --upper");
        journal = {journal_file, every};
        for (const std::string& kept : {watch, journal_file})
            if (!kept.empty()) t.claim(kept);
        CloudFile file = read_cloud(points, unit ? std::optional(Units{*unit, Units::Force::N}) : std::nullopt);
        const double mm = file.units.mm();
        Surfels surfels = surfels_of(file.cloud, display_name(points));
        const ContactWheel wheel = read_contact_wheel(wheel_file);
        CloudFile path_cloud = read_cloud(path_file);
        BeltSettings settings{force, depth ? std::optional(*depth * mm) : std::nullopt, feed ? *feed * mm : 20, dwell};
        BeltOptions options;
        options.press = {gridding == "shepard" ? Gridding::shepard : Gridding::kriging, cells, tolerance};
        options.model = model == "global" ? BeltModel::global : BeltModel::local;
        options.worn = worn * kJoule;
        std::optional<BeltWatch> watched;
        if (lower) {
            options.range = {*lower * mm, *upper * mm};
            watched.emplace(watch, mm);
        }
        const auto listener = [&](const BeltRun& run) {
            if (watched) watched->write(run);
        };
        const std::vector<BeltPoint> path =
            named(display_name(path_file), [&] { return belt_path(path_cloud.cloud, settings); });
        BeltRun run;
        try {
            run = grind(surfels, wheel, path, options, journal, listener, t.progress("grinding"));
        } catch (const InputError& error) {
            if (!std::string(error.what()).starts_with("point ")) throw;
            throw InputError(display_name(path_file), error.what());
        }
        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        if (!trace.empty()) {
            set_trace(path_cloud.cloud, run);
            write_pcd(t.output_file(trace), path_cloud.cloud, path_cloud.units, encoding);
        }
        if (has_field(file.cloud, "removed")) run.removed += field(file.cloud, "removed");
        set_field(file.cloud, "displacement", surfels.displacement, 8);
        set_field(file.cloud, "removed", run.removed, 8);
        report(t.report(), run, surfels, mm);
        if (run.near_edge > 0)
            t.warn(std::to_string(run.near_edge) + " contacts are nearer to the wheel's edge than 1.5 thicknesses of "
                                                   "its layer, where it is softer than reckoned");
        write_pcd(t.output(), file.cloud, file.units, encoding);
        return Verdict::yes;
    });
}
