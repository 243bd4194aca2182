#include "gantry/dynamic.h"

#include "core/error.h"
#include "core/text.h"
#include "gantry/force_tuning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fettle::gantry {
namespace {

/// A move has ended when the encoder is this close to the command, or after a while.
constexpr double kSettledCounts = 3;
constexpr double kMaxSettlingTime = 0.5; // s
/// Share of a force that the spring may reach over the braking distance of the drives after a contact.
constexpr double kContactForceShare = 0.5;
/// Shares of the desired deflection: one that counts as a contact, and one that the search for the part may reach over
/// the braking distance of the drives.
constexpr double kContactShare = 0.1, kSearchShare = 0.2;
/// After a corner the command returns to the line within the time to reach the feed, but no faster than the loops.
constexpr double kMinCornerPeriods = 4;

std::array<ServoAxis, 3> servo_axes(const Machine& machine, const removal::Spring& spring, const Eigen::Vector3d& at)
{
    const auto axis = [&](int k, double stiffness, double damping) {
        return ServoAxis(machine.axes[k], stiffness, damping, machine.period, at[k]);
    };
    return {axis(0, 0, 0), axis(1, 0, 0), axis(2, spring.stiffness, machine.head.damping)};
}

/// Largest speed at the end of a period that still allows to stop within a distance.
/// @param r, v  distance and speed at the beginning of the period
double braking_speed(double r, double v, double a, double period)
{
    const double half = a * period / 2;
    return -half + std::sqrt(std::max(half * half + 2 * a * r - 2 * half * v, 0.0));
}

} // namespace

DynamicGantry::DynamicGantry(removal::HeightField stock, const job::Job& job, const Machine& machine,
                             const DynamicOptions& options)
    : VirtualGantry(std::move(stock), job, options, {true, machine.spindle.tangential}), machine_(machine),
      axes_(servo_axes(machine, spring_, status_.commanded)),
      acceleration_(
          std::min({machine.axes[0].acceleration, machine.axes[1].acceleration, machine.axes[2].acceleration})),
      force_gains_(tune_force(machine.axes[2], spring_.stiffness, machine.head.damping, machine.period)),
      random_(options.seed), line_end_(status_.commanded), tip_(status_.commanded.z()),
      contact_position_(status_.commanded),
      spindle_energy_(machine.spindle.inertia * machine.spindle.speed * machine.spindle.speed / 2)
{
    reference_.p = status_.commanded;
    options_.touch_resolution = machine.axes[2].encoder;
    check_range(status_.commanded);
    turn_head(job.theta);
}

/// Turns the head from 0, while the other axes are at rest.
void DynamicGantry::turn_head(double theta)
{
    const Drive& c = machine_.c;
    if (!(theta >= c.min_position && theta <= c.max_position))
        throw core::InputError(machine_.source,
                               "axes.c cannot turn to " + core::to_short_text(theta * 180 / std::numbers::pi) + "°");
    ServoAxis axis(c, 0, 0, machine_.period, 0);
    Reference reference;
    const double direction = theta < 0 ? -1 : 1;
    const auto settled = [&] {
        return reference.p == theta && std::abs(axis.measured() - theta) <= kSettledCounts * c.encoder;
    };
    for (double waited = 0; !settled() && waited < kMaxSettlingTime;) {
        const double rest = direction * (theta - reference.p), speed = direction * reference.v;
        const double next = std::min({speed + c.acceleration * machine_.period, c.speed,
                                      braking_speed(rest, speed, c.acceleration, machine_.period)});
        const bool reached = rest <= c.acceleration * machine_.period * machine_.period;
        reference.a = reached ? 0 : direction * (next - speed) / machine_.period;
        axis.step(reference, 0);
        reference.p = reached ? theta : reference.p + direction * (speed + next) / 2 * machine_.period;
        reference.v = reached ? 0 : direction * next;
        if (reached) waited += machine_.period;
        advance_time(machine_.period, TimeBucket::travel);
    }
}

GantryStatus DynamicGantry::travel(const Eigen::Vector3d& tool_point)
{
    check_range(tool_point);
    begin_move();
    go_to_safe_height();
    const double across = std::min(machine_.axes[0].speed, machine_.axes[1].speed);
    move_to({tool_point.x(), tool_point.y(), reference_.p.z()}, across, false);
    return lift(tool_point.z());
}

GantryStatus DynamicGantry::travel_low(const Eigen::Vector3d& tool_point, double over, double free)
{
    check_range(tool_point);
    check_range({tool_point.x(), tool_point.y(), over});
    begin_move();
    raise_from_part(over);
    const double across = std::min(machine_.axes[0].speed, machine_.axes[1].speed);
    move_to({tool_point.x(), tool_point.y(), reference_.p.z()}, across, false);
    const double down = std::max(free, tool_point.z());
    if (down < reference_.p.z()) move_to({tool_point.x(), tool_point.y(), down}, machine_.axes[2].speed, false);
    return lift(tool_point.z());
}

GantryStatus DynamicGantry::lift(double commanded_z)
{
    check_range({reference_.p.x(), reference_.p.y(), commanded_z});
    begin_move();
    time_bucket_ = TimeBucket::travel;
    stop();
    if (commanded_z > reference_.p.z())
        move_to({reference_.p.x(), reference_.p.y(), commanded_z}, machine_.axes[2].speed, false);
    else
        lower_to(commanded_z);
    line_end_ = reference_.p;
    return status_;
}

GantryStatus DynamicGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    return follow_line(tool_point, feed, std::nullopt);
}

GantryStatus DynamicGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    return follow_line(tool_point, feed, force);
}

/// Grinds in a straight line. With a force the line is horizontal, and Z is force-controlled.
GantryStatus DynamicGantry::follow_line(const Eigen::Vector3d& tool_point, double feed, std::optional<double> force)
{
    check_positive(feed, "feed");
    check_range(tool_point);
    begin_move();
    time_bucket_ = TimeBucket::grinding;
    const auto in_path = [&](const Eigen::Vector3d& v) { return force ? Eigen::Vector3d(v.x(), v.y(), 0) : v; };
    const Eigen::Vector3d motion = in_path(tool_point - line_end_);
    const double length = motion.norm();
    if (length == 0) return status_;
    const Eigen::Vector3d along = motion / length;
    const double max_change = acceleration_ * machine_.period;
    const double deflection = force ? std::max(*force - spring_.preload, 0.0) / spring_.stiffness : 0;
    if (force && !force_loop_) approach_part(tool_point.z(), deflection);
    while (in_path(reference_.p - tool_point).dot(along) < 0) {
        const Eigen::Vector3d v = in_path(reference_.v);
        const Eigen::Vector3d change = velocity_along_line(in_path(reference_.p - line_end_), along, feed) - v;
        const double size = change.norm();
        Eigen::Vector3d next = v + (size > max_change ? change * (max_change / size) : change);
        if (force) next.z() = force_control_speed(tool_point.z(), deflection);
        move_reference(next);
    }
    line_end_ << tool_point.head<2>(), force ? reference_.p.z() : tool_point.z();
    totals_.grinding_length += length;
    return status_;
}

/// Velocity of the command along a line and back to it.
/// @param off  position relative to a point of the line
Eigen::Vector3d DynamicGantry::velocity_along_line(const Eigen::Vector3d& off, const Eigen::Vector3d& along,
                                                   double feed) const
{
    const double return_time = std::max(feed / acceleration_, kMinCornerPeriods * machine_.period);
    return feed * along - (off - off.dot(along) * along) / return_time;
}

/// Descends in place under force control until the wheel is on the part.
void DynamicGantry::approach_part(double lowest, double deflection)
{
    const Drive& z = machine_.axes[2];
    force_loop_.emplace(force_gains_, machine_.period, z.speed, z.acceleration);
    while (status_.deflection < kContactShare * deflection && reference_.p.z() > lowest + z.encoder)
        move_reference({0, 0, force_control_speed(lowest, deflection)});
    line_end_ = reference_.p;
}

/// Speed of Z that controls the deflection. It is limited so that Z can stop at a contact, and at `lowest`.
double DynamicGantry::force_control_speed(double lowest, double deflection)
{
    const double rest = std::max(reference_.p.z() - lowest, 0.0), sinking = std::max(-reference_.v.z(), 0.0);
    const double braking = std::max(braking_speed(rest, sinking, acceleration_, machine_.period), 0.0);
    const double search = max_contact_speed(kSearchShare * spring_.stiffness * deflection);
    const double max_down = status_.deflection > kContactShare * deflection ? machine_.axes[2].speed : search;
    return force_loop_->step(deflection, status_.deflection, reference_.v.z(), std::min(max_down, braking));
}

protocol::Limits DynamicGantry::limits() const
{
    const auto& [x, y, z] = machine_.axes;
    return {{x.min_position, y.min_position, z.min_position},
            {x.max_position, y.max_position, z.max_position},
            Eigen::Vector3d(x.speed, y.speed, z.speed).norm(),
            spring_.force(machine_.head.travel)};
}

void DynamicGantry::check_range(const Eigen::Vector3d& tool_point) const
{
    for (int k = 0; k < 3; ++k) {
        const Drive& drive = machine_.axes[k];
        if (tool_point[k] >= drive.min_position && tool_point[k] <= drive.max_position) continue;
        throw core::InputError(machine_.source, std::string("axes.") + "xyz"[k] + " goes from " +
                                                    core::to_short_text(drive.min_position) + " to " +
                                                    core::to_short_text(drive.max_position) + " mm; the work needs " +
                                                    core::to_short_text(tool_point[k]));
    }
}

/// Brakes to rest on a straight line.
void DynamicGantry::stop()
{
    force_loop_.reset();
    while (reference_.v.squaredNorm() > 0) {
        const double speed = reference_.v.norm();
        move_reference(reference_.v * std::max(0.0, 1 - acceleration_ * machine_.period / speed));
    }
}

/// Moves from rest to rest in a straight line. A guarded move stops when the force at its end would reach F_max.
void DynamicGantry::move_to(const Eigen::Vector3d& target, double speed, bool guarded)
{
    const double a = acceleration_, period = machine_.period;
    const double length = (target - reference_.p).norm();
    if (length == 0) return;
    const Eigen::Vector3d along = (target - reference_.p) / length;
    for (double v = 0;;) {
        const double rest = (target - reference_.p).dot(along);
        if (rest <= a * period * period) break;
        const double ahead = spring_.stiffness * v * (v / (2 * a) + period);
        const bool stopping = guarded && status_.force + ahead >= max_force_;
        v = stopping ? std::max(v - a * period, 0.0)
                     : std::min({v + a * period, speed, braking_speed(rest, v, a, period)});
        move_reference(v * along);
        if (stopping && v == 0) break;
    }
    stop();
    if ((target - reference_.p).dot(along) <= a * period * period) reference_.p = target;
    const auto settled = [&] {
        for (int k = 0; k < 3; ++k) {
            if (std::abs(axes_[k].measured() - reference_.p[k]) > kSettledCounts * machine_.axes[k].encoder)
                return false;
        }
        return true;
    };
    for (double waited = 0; !settled() && waited < kMaxSettlingTime; waited += period) move_reference({0, 0, 0});
}

/// Speed from which the drives stop after a contact before the spring has that force.
double DynamicGantry::max_contact_speed(double force) const
{
    return std::sqrt(2 * acceleration_ * kContactForceShare * force / spring_.stiffness);
}

void DynamicGantry::lower_to(double z)
{
    move_to({reference_.p.x(), reference_.p.y(), z}, std::min(machine_.axes[2].speed, max_contact_speed(max_force_)),
            true);
}

void DynamicGantry::go_to_safe_height() { raise_from_part(safe_height_); }

void DynamicGantry::raise_from_part(double z)
{
    time_bucket_ = TimeBucket::travel;
    stop();
    const Eigen::Vector3d up(reference_.p.x(), reference_.p.y(), std::max(z, reference_.p.z()));
    move_to(up, machine_.axes[2].speed, false);
    line_end_ = reference_.p;
}

/// Simulates a period at whose end the command has this velocity.
void DynamicGantry::move_reference(const Eigen::Vector3d& velocity)
{
    reference_.a = (velocity - reference_.v) / machine_.period;
    simulate_period();
    reference_.p += (reference_.v + velocity) / 2 * machine_.period;
    reference_.v = velocity;
    check_interrupt();
}

} // namespace fettle::gantry
