#include "cli/tool.h"
#include "core/descriptor.h"
#include "gantry/linuxcnc.h"
#include "gantry/serve.h"
#include "plan/plan.h"

#include <unistd.h>

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Drive a gantry behind LinuxCNC.", [](Tool& t) {
        const std::string& plan_file =
            t.file("PLAN", "The plan whose job the machine is set up for, or a job without a plan, JSON");
        const std::string& ini = t.required_file("--ini", "FILE", "What LinuxCNC was started with");
        t.example("fettle-grind plan.json --stock part.stl > ground.pcd --gantry 'exec:machines/linuxcnc/within DIR "
                  "fettle-gantry-linuxcnc plan.json --ini DIR/grind.ini'",
                  "grind on the machine that machines/linuxcnc/start DIR has started");
        t.reference("docs/driver.md: the protocol; docs/linuxcnc.md: the machine");
        t.without_output();
        t.parse();

        const Job job = read_work(plan_file).job;
        const Descriptor in(::dup(STDIN_FILENO)), out(::dup(STDOUT_FILENO));
        LinuxcncGantry gantry(ini, job);
        serve(gantry, gantry.limits(), job, in, out);
        return Verdict::yes;
    });
}
