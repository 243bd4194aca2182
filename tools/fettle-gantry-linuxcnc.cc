#include "cli/tool.h"
#include "core/descriptor.h"
#include "gantry/linuxcnc.h"
#include "gantry/serve.h"
#include "plan/plan.h"

#include <unistd.h>

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Drive a gantry behind LinuxCNC.", [](cli::Tool& t) {
        const std::string& plan_file =
            t.positional_file("PLAN", "The plan whose job the machine is set up for, or a job without a plan, JSON");
        const std::string& ini = t.required_file_option("--ini", "FILE", "What LinuxCNC was started with");
        t.example("fettle-grind plan.json --stock part.stl > ground.pcd --gantry 'exec:machines/linuxcnc/within DIR "
                  "fettle-gantry-linuxcnc plan.json --ini DIR/grind.ini'",
                  "grind on the machine that machines/linuxcnc/start DIR has started");
        t.reference("docs/driver.md: the protocol; docs/linuxcnc.md: the machine");
        t.disable_output();
        t.parse();

        const job::Job job = plan::read_job_or_plan(plan_file).job;
        const core::FileDescriptor in(::dup(STDIN_FILENO)), out(::dup(STDOUT_FILENO));
        gantry::LinuxcncGantry gantry(ini, job);
        gantry::serve(gantry, gantry.limits(), job, in, out);
        return cli::Verdict::yes;
    });
}
