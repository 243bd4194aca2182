// What a driver's answers have to agree with.

#include "gantry/driver.h"

#include "core/error.h"
#include "core/text.h"

namespace fettle::gantry {
namespace {

/// Tolerances for the speed and the clock of a machine, which are reported with a few digits.
constexpr double kSpeedFactor = 1.01;
constexpr double kTimeTolerance = 0.01; // s
/// A machine's clock counts from its start: it has been on for less than a year. The seconds since 1970 are more.
constexpr double kMaxStartClock = 3e7; // s
/// New wheels are cut to a few percent of their size; one that measures more is another wheel, or no measurement.
constexpr double kMaxRadiusFactor = 1.1; // relative to the job's
/// A guarded descent stops for F_max; drives that brake early stop for half of it.
constexpr double kMinGuardShare = 0.25; // of F_max

} // namespace

/// A wheel does not grow, and it is not larger than the job's.
void DriverGantry::check_radius(double radius)
{
    const std::string measured = "measures a wheel of " + core::to_short_text(radius) + " mm";
    if (!(radius > 0)) fail(measured);
    if (radius > kMaxRadiusFactor * new_radius_)
        fail(measured + "; a new one has " + core::to_short_text(new_radius_) + " mm");
    if (last_radius_ > 0 && radius > last_radius_ + height_tolerance_)
        fail(measured + ", which had " + core::to_short_text(last_radius_) + " mm before");
    last_radius_ = radius;
}

/// A guarded descent ends early only on metal, so the head must report a force: else the strategy would take air for
/// metal.
void DriverGantry::check_contact(const Eigen::Vector3d& target, const std::string& command)
{
    const double above = status_.commanded.z() - target.z();
    if (above > height_tolerance_ && status_.peak_force < kMinGuardShare * head_.max_force)
        fail("stops " + core::to_short_text(above) + " mm early after '" + command + "', but reported at most " +
             core::to_short_text(status_.peak_force) + " N");
}

void DriverGantry::accept(const GantryStatus& status)
{
    check_head(head_, status);
    check_time(status.time);
    const double time = status.time - status_.time;
    const double distance = (status.commanded - status_.commanded).norm();
    if (has_status_ && distance > kSpeedFactor * limits_.speed * (time + kTimeTolerance))
        throw GantryFault("jumps by " + core::to_short_text(distance) + " mm in " + core::to_short_text(time) + " s");
    if (((status.commanded - limits_.min).array() < -protocol::kPositionTolerance).any() ||
        ((status.commanded - limits_.max).array() > protocol::kPositionTolerance).any())
        throw GantryFault("stands at " + protocol::to_words(status.commanded) + ", out of its range");
    status_ = status;
    status_clock_ = std::chrono::steady_clock::now();
    has_status_ = true;
}

/// Between two answers the clock advances by the time of the command, and by that in which the client was idle.
void DriverGantry::check_time(double time) const
{
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - status_clock_;
    if (!has_status_ && !(std::abs(time) <= kMaxStartClock))
        throw GantryFault("begins at " + core::to_short_text(time) + " s, which is no time since the machine's start");
    if (!has_status_) return;
    if (time < status_.time) throw GantryFault("goes back in time, to " + core::to_text(time) + " s");
    if (time - status_.time > max_duration_ + waited.count())
        throw GantryFault("jumps ahead in time by " + core::to_short_text(time - status_.time) + " s");
}

/// The machine has to be above the expected position, at any height.
void DriverGantry::check_position(const Eigen::Vector3d& expected, const std::string& command)
{
    if ((status_.commanded - expected).head<2>().norm() > protocol::kPositionTolerance)
        fail("stands at " + protocol::to_words(status_.commanded) + " after '" + command + "'");
}

void DriverGantry::check_range(const Eigen::Vector3d& target) const
{
    if ((target.array() >= limits_.min.array()).all() && (target.array() <= limits_.max.array()).all()) return;
    throw core::InputError(command_, "the machine does not reach " + protocol::to_words(target) + " mm");
}

void DriverGantry::check_feed(double feed) const
{
    if (!(feed > 0 && feed <= limits_.speed))
        throw core::InputError("gantry", "a feed of " + core::to_text(feed) + " mm/s is not in the machine's range");
}

} // namespace fettle::gantry
