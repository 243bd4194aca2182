#include "gantry/loops.h"

#include "core/text.h"
#include "gantry/force_tuning.h"

#include <numbers>

namespace fettle::gantry {
namespace {

double phase_margin_degrees(const ControlLoop& loop) { return loop.margins.phase * 180 / std::numbers::pi; }

} // namespace

std::vector<ControlLoop> tune_loops(const Machine& machine, const job::Job& job)
{
    std::vector<ControlLoop> loops;
    const auto add = [&](const std::string& name, const Drive& drive, double k, double b, bool loaded) {
        const ServoGains gains = tune_servo(drive, k, b, machine.period);
        const Oscillator load{drive.mass, drive.damping + (loaded ? b : 0), loaded ? k : 0};
        loops.push_back(
            {name, gains.bandwidth, servo_response(drive, load, machine.period, kMarginFrequencies).margins(gains)});
    };
    const double k = job.force.stiffness, b = machine.head.damping;
    add("x", machine.axes[0], 0, 0, false);
    add("y", machine.axes[1], 0, 0, false);
    add("z", machine.axes[2], k, b, false);
    add("z against the spring", machine.axes[2], k, b, true);
    add("c", machine.c, 0, 0, false);
    const Drive& z = machine.axes[2];
    const Pid force = tune_force(z, k, b, machine.period);
    const ServoGains servo = tune_servo(z, k, b, machine.period);
    loops.push_back(
        {"force", force.kp, force_response(z, servo, {z.mass, z.damping + b, k}, machine.period).margins(force)});
    return loops;
}

json::Value to_json(const ControlLoop& loop)
{
    return json::Value()
        .set("loop", loop.name)
        .set("bandwidth", loop.bandwidth)
        .set("gain_margin", loop.margins.gain)
        .set("phase_margin_deg", phase_margin_degrees(loop));
}

std::string to_string(const ControlLoop& loop)
{
    return "loop " + loop.name + ": bandwidth " + core::to_short_text(loop.bandwidth) + " rad/s, gain margin " +
           core::to_short_text(loop.margins.gain) + ", phase margin " +
           core::to_short_text(phase_margin_degrees(loop)) + "\u00B0";
}

} // namespace fettle::gantry
