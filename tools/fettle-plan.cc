#include "cli/tool.h"
#include "core/file.h"
#include "job/plausible.h"
#include "plan/gcode.h"
#include "plan/plan.h"
#include "plan/tool_path.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Plan the layers, the start and the zig-zag passes over an anomaly.", [](cli::Tool& t) {
            const std::string& job_file = t.positional_file("JOB", "The operator's job, JSON");
            const std::string& surface_file = t.main_input("SURFACE", "the desired surface, JSON (fettle-margin)");
            const std::string& gcode =
                t.choice("--gcode", "", {"linuxcnc", "grbl"},
                         "Write layer 1 alone as G-code for this controller, instead of the plan");
            t.example(
                "fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json > plan.json",
                "layers and passes for Wang's part 1, whose job holds the touches");
            t.reference(
                "Wang 2007, 5.3: layers (eq. 5-1 to 5-3), start (5-4 to 5-6), staircase; 3.4: the wheel must fit");
            t.parse();

            const job::Job job = job::read_job(job_file);
            const surface::Surface surface = surface::read_surface(surface_file);
            job::check_touch_places({surface.touches, surface.roles}, job, core::display_name(surface_file));
            const plan::Plan plan = plan::make_plan(job, surface);
            if (gcode.empty())
                t.output() << plan::to_json(plan);
            else
                plan::write_gcode(t.output(), plan, plan::ToolPath(plan.job, plan.surface, plan.passes, plan.step),
                                  gcode == "grbl" ? plan::GcodeDialect::grbl : plan::GcodeDialect::linuxcnc);
            t.report() = plan::report_json(plan);
            return cli::Verdict::yes;
        });
}
