#include "strategy/contact_watch.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle::strategy {
namespace {

/// Distance of two evaluated positions of the wheel in cells, as in replay_removal().
constexpr double kWatchStepCells = 2;
/// Largest ratio of the stock's removal coefficient to the job's.
constexpr double kMaxSoftness = 10;
/// Force that any transducer fit for the job reports, relative to the increase of the spring's force over the
/// tolerance.
constexpr double kMinReadingShare = 0.1;

} // namespace

ContactWatch::ContactWatch(const removal::HeightField& stock, const job::Job& job)
    : stock_(stock), wheel_(stock_, job.wheel.width), R_working_machine_(job::rotation_working_machine(job.theta)),
      radius_(job.wheel.radius), width_(job.wheel.width), tolerance_(job.tolerance), removal_(job.removal_coefficient),
      preload_(job.force.preload), min_force_(kMinReadingShare * job.force.stiffness * job.tolerance),
      // Up to this distance the rim is within the tolerance of its lowest line, so an edge may be displaced by as much.
      max_length_without_force_(std::sqrt(2 * job.wheel.radius * job.tolerance))
{
}

void ContactWatch::follow(const gantry::GantryStatus& status, double feed)
{
    const Eigen::Vector3d from = tip_, to = status.commanded + status.deflection * Eigen::Vector3d::UnitZ();
    const double duration = status.time - time_, force = std::max(last_force_, status.peak_force);
    const bool had_tip = has_tip_;
    tip_ = to;
    time_ = status.time;
    last_force_ = status.force;
    has_tip_ = true;
    if (!had_tip || !(feed > 0)) return void(length_without_force_ = 0);

    const double length = (to - from).norm();
    const int steps = std::max(1, int(std::ceil(length / (kWatchStepCells * stock_.cell))));
    double removed = -tolerance_ * width_ * length; // stock no higher than the tolerance may be missing
    for (int n = 1; n <= steps; ++n) removed += remove_to(from + (to - from) * (double(n) / steps));
    // The force that removes this volume, if the clock of the machine is not too coarse for the step.
    const double needed = removed / (removal_ * std::max(duration, length / feed));
    if (!(needed > kMaxSoftness * (std::max(force, preload_) + min_force_))) return void(length_without_force_ = 0);
    length_without_force_ += length;
    if (length_without_force_ < max_length_without_force_) return;
    throw gantry::GantryFault("no contact is reported at x " + core::to_short_text(to.x()) + ", y " +
                              core::to_short_text(to.y()) + " mm: what stands there of the stock takes " +
                              core::to_short_text(needed) + " N, at most " + core::to_short_text(force) +
                              " N were reported");
}

/// Removes the stock above the wheel. @return  its volume, mm³
double ContactWatch::remove_to(const Eigen::Vector3d& tip)
{
    wheel_.place(R_working_machine_ * tip.head<2>(), radius_, tip.z());
    const double volume = wheel_.overlap(tip.z()).volume;
    wheel_.cut(tip.z());
    return volume;
}

} // namespace fettle::strategy
