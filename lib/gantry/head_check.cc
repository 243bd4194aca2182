#include "gantry/head_check.h"

#include "core/text.h"

#include <algorithm>

namespace fettle::gantry {
namespace {

/// No head travels farther. It bounds what a driver reports whose head is not known.
constexpr double kMaxTravel = 1000; // mm
/// Noise of the transducer: among the million readings of a long run none is farther off.
constexpr double kNoiseSigmas = 5;

std::string number(double value) { return core::to_short_text(value); }

} // namespace

HeadCheck head_check(const job::Job& job, const std::optional<Head>& head)
{
    HeadCheck check{.preload = job.force.preload,
                    .stiffness = job.force.stiffness,
                    .max_force = job.force.max,
                    .tolerance = job.tolerance,
                    .travel = kMaxTravel};
    if (job.force.min > 0) check.tolerance = std::min(check.tolerance, job.force.min / job.force.stiffness);
    if (!head) return check;
    check.tolerance = head->lvdt + kNoiseSigmas * head->noise;
    check.travel = head->travel;
    return check;
}

void check_head(const HeadCheck& head, const GantryStatus& status)
{
    const double deflection = status.deflection, force = status.force;
    const auto spring = [&](double at) { return head.preload + head.stiffness * at; };
    if (force < 0 || deflection < 0 || status.peak_force < force)
        throw GantryFault("reports a force of " + core::to_text(force) + " N, at most " +
                          core::to_text(status.peak_force) + " N, at a deflection of " + core::to_text(deflection) +
                          " mm");
    if (deflection > head.travel + head.tolerance)
        throw GantryFault("reports a deflection of " + number(deflection) + " mm; the head travels " +
                          number(head.travel) + " mm");
    if (status.peak_force > spring(head.travel + head.tolerance))
        throw GantryFault("reports a force of " + number(status.peak_force) + " N; the head's spring has at most " +
                          number(spring(head.travel)) + " N");
    if (force >= head.max_force) return;
    const double min = deflection > head.tolerance ? spring(deflection - head.tolerance) : 0;
    if (force < min || force > spring(deflection + head.tolerance))
        throw GantryFault("reports a force of " + number(force) + " N at a deflection of " + number(deflection) +
                          " mm, where the head's spring has " + number(spring(deflection)) + " N");
}

} // namespace fettle::gantry
