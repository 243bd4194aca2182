#include "cli/tool.h"
#include "plan/gcode.h"
#include "plan/plan.h"
#include "plan/tool_path.h"

#include <ostream>

using namespace fettle;

namespace {

void report(json::Value& out, const Plan& plan)
{
    const double mm = plan.job.units.mm();
    double length = 0, widest = 0;
    for (std::size_t p = 0; p < plan.passes.size(); ++p) {
        for (const Interval& interval : plan.passes[p].intervals) length += interval.second - interval.first;
        if (p > 0) widest = std::max(widest, plan.passes[p].line - plan.passes[p - 1].line);
    }
    out.set("layer_thickness", plan.layers.thickness / mm)
        .set("layer_distance", plan.layers.distance / mm)
        .set("overlap_case", plan.layers.overlap_case)
        .set("most_layers", plan.bounds.layers)
        .set("passes", plan.passes.size())
        .set("widest_step_over", widest / mm)
        .set("covering_length", length / mm)
        .set("covering_time", length / plan.job.feed.rate);
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Plan the layers, the start and the zig-zag passes over an anomaly.", [](Tool& t) {
        const std::string& job_file = t.file("JOB", "The operator's job, JSON");
        const std::string& surface_file = t.input("SURFACE", "the desired surface, JSON (fettle-margin)");
        const std::string& gcode = t.choice("--gcode", "", {"linuxcnc", "grbl"},
                                            "Write layer 1 alone as G-code for this controller, instead of the plan");
        t.example(
            "fettle-sample jobs/wang1.json | fettle-fit jobs/wang1.json | fettle-plan jobs/wang1.json > plan.json",
            "layers and passes for Wang's part 1, whose job holds the touches");
        t.reference("Wang 2007, 5.3: layers (eq. 5-1 to 5-3), start (5-4 to 5-6), staircase; 3.4: the wheel must fit");
        t.parse();

        const Plan plan = make_plan(read_job(job_file), read_surface(surface_file));
        if (gcode.empty())
            t.output() << to_json(plan);
        else
            write_gcode(t.output(), plan, ToolPath(plan.job, plan.surface, plan.passes, plan.step),
                        gcode == "grbl" ? GcodeDialect::grbl : GcodeDialect::linuxcnc);
        report(t.report(), plan);
        return Verdict::yes;
    });
}
