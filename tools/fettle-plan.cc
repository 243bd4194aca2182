#include "cli/output_format.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "gantry/gantry_options.h"
#include "gantry/make_virtual.h"
#include "job/plausible.h"
#include "plan/gcode.h"
#include "plan/plan.h"
#include "plan/pose_path.h"
#include "plan/tool_path.h"
#include "strategy/choose_force_down.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& job = t.positional_file("JOB", "The operator's job, JSON");
    const std::string& surface = t.main_input("SURFACE", "the desired surface, JSON (fettle-margin)");
    const std::string& gcode = t.choice("--gcode", "", {"linuxcnc", "grbl"},
                                        "Write layer 1 alone as G-code for this controller, instead of the plan");
    const std::string& path =
        t.optional_output("--path",
                          "Write the passes as the tool path of a robot, too, in the part's frame: tip, wheel's plane, "
                          "normal, layer, stroke, feed and limits of force",
                          cloud::cloud_formats());
    const int& layers = t.count("--layers", 1, "Number of layers in --path, from the highest down", 1, 10000);
    const std::string& force_down =
        t.choice("--f-down", "job", {"job", "auto"},
                 "F_down: the job's, or the one with which the simulated part is ground fastest");
    gantry::StockOptions stock{t, "simulated for --f-down auto"};
    const double& removal_factor = gantry::declare_removal_factor(t);
};

/// Grinds the simulated part with several F_down. Sets the job's safe height over that part, if it has none.
strategy::ForceDownChoice choose_force_down(const Options& o, job::Job& job, const surface::Surface& surface)
{
    const auto [stock, doubts, dropped] = gantry::read_stock(o.stock, job, removal::Extent::anomaly);
    job = gantry::with_safe_height_over(stock, std::move(job));
    const job::Job complete = plan::make_plan(job, surface).job;
    gantry::require_below_safe_height(stock, complete, core::display_name(o.stock.file));
    for (const std::string& doubt : doubts) o.t.warn(doubt);
    return strategy::choose_force_down(job, surface, [&, &field = stock](const job::Job& tried) {
        return gantry::make_virtual_gantry(field, tried, {"", o.removal_factor, 1});
    });
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Plan the layers, the start and the zig-zag passes over an anomaly.", [](cli::Tool& t) {
            const Options o{t};
            t.example(
                "fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json > plan.json",
                "layers and passes for Wang's part 1, whose job holds the touches");
            t.reference(
                "Wang 2007, 5.3: layers (eq. 5-1 to 5-3), start (5-4 to 5-6), staircase; 3.4: the wheel must fit");
            const std::vector<std::string> programs = {"nc", "ngc", "gcode", "tap"};
            t.output_formats({"json", "nc", "ngc", "gcode", "tap"});
            t.parse();
            cli::format_of_output(t.output_name(), o.gcode.empty() ? std::vector<std::string>{"json"} : programs);
            const bool chooses = o.force_down == "auto";
            if (chooses == o.stock.file.empty())
                throw core::InputError("--stock", "the part, and --f-down auto, which simulates it, go together");

            job::Job job = job::read_job(o.job);
            const surface::Surface surface = surface::read_surface(o.surface);
            job::check_touch_places({surface.touches, surface.roles}, job, core::display_name(o.surface));
            std::optional<strategy::ForceDownChoice> choice;
            if (chooses) {
                choice = choose_force_down(o, job, surface);
                job.force.down = choice->trials[choice->chosen].force_down;
            }
            const plan::Plan plan = plan::make_plan(job, surface);
            const auto tool_path = [&] { return plan::ToolPath(plan.job, plan.surface, plan.passes, plan.step); };
            if (!o.path.empty())
                cloud::write_cloud(t, o.path, plan::pose_path(plan, tool_path(), o.layers), plan.job.units);
            if (o.gcode.empty())
                t.output() << plan::to_json(plan);
            else
                plan::write_gcode(t.output(), plan, tool_path(),
                                  o.gcode == "grbl" ? plan::GcodeDialect::grbl : plan::GcodeDialect::linuxcnc);
            t.report() = plan::report_json(plan);
            if (choice) t.report().set("force_down", strategy::to_json(*choice, job.units));
            return cli::Verdict::yes;
        });
}
