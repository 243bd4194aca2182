#include "gantry/loops.h"

#include "gantry/force_tuning.h"

namespace fettle {

std::vector<Loop> loops_of(const Machine& machine, const Job& job)
{
    std::vector<Loop> loops;
    const auto add = [&](const std::string& name, const Drive& drive, double k, double b, bool loaded) {
        const ServoGains gains = tune(drive, k, b, machine.period);
        const Oscillator load{drive.mass, drive.damping + (loaded ? b : 0), loaded ? k : 0};
        loops.push_back(
            {name, gains.bandwidth, servo_response(drive, load, machine.period, kFineFrequencies).margins(gains)});
    };
    const double k = job.force.stiffness, b = machine.head.damping;
    add("x", machine.axes[0], 0, 0, false);
    add("y", machine.axes[1], 0, 0, false);
    add("z", machine.axes[2], k, b, false);
    add("z against the spring", machine.axes[2], k, b, true);
    add("c", machine.c, 0, 0, false);
    const Drive& z = machine.axes[2];
    const Pid force = tune_force(z, k, b, machine.period);
    const ServoGains servo = tune(z, k, b, machine.period);
    loops.push_back(
        {"force", force.kp, force_response(z, servo, {z.mass, z.damping + b, k}, machine.period).margins(force)});
    return loops;
}

} // namespace fettle
