#include "gantry/dynamic.h"

#include "core/error.h"
#include "core/text.h"
#include "gantry/force_tuning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fettle {
namespace {

/// A command at rest is followed when the encoder reads it to a few counts, or has had time enough.
constexpr double kSettled = 3;        // counts
constexpr double kMostSettling = 0.5; // s
/// Touching may use half of what F_max leaves for the way the drives need to stop.
constexpr double kTouchShare = 0.5;
/// The part is felt where the spring bends by this share of what is wanted; what it is searched with goes on to bend it
/// by so much while the drives stop.
constexpr double kFelt = 0.1, kGentle = 0.2;
/// Corners are rounded back to the line within as long as it takes to reach the feed, but no faster than the loops.
constexpr double kLeastPeriods = 4;

std::array<ServoAxis, 3> servo_axes(const Machine& machine, const Spring& spring, const Eigen::Vector3d& at)
{
    const auto axis = [&](int k, double stiffness, double damping) {
        return ServoAxis(machine.axes[static_cast<std::size_t>(k)], stiffness, damping, machine.period, at[k]);
    };
    return {axis(0, 0, 0), axis(1, 0, 0), axis(2, spring.stiffness, machine.head.damping)};
}

/// Speed at the end of a period from which the rest of the way, r at its beginning, is enough to stop.
double speed_to_stop(double r, double v, double a, double period)
{
    const double half = a * period / 2;
    return -half + std::sqrt(std::max(half * half + 2 * a * r - 2 * half * v, 0.0));
}

} // namespace

DynamicGantry::DynamicGantry(HeightField stock, const Job& job, const Machine& machine, const DynamicOptions& options)
    : VirtualGantry(std::move(stock), job, options, {true, machine.spindle.tangential}), machine_(machine),
      axes_(servo_axes(machine, spring_, status_.commanded)),
      acceleration_(
          std::min({machine.axes[0].acceleration, machine.axes[1].acceleration, machine.axes[2].acceleration})),
      force_gains_(tune_force(machine.axes[2], spring_.stiffness, machine.head.damping, machine.period)),
      random_(options.seed), line_end_(status_.commanded), tip_(status_.commanded.z()), met_at_(status_.commanded),
      spindle_energy_(machine.spindle.inertia * machine.spindle.speed * machine.spindle.speed / 2),
      account_(&totals_.travel_time)
{
    reference_.p = status_.commanded;
    options_.touch_resolution = machine.axes[2].encoder;
    check_range(status_.commanded);
    turn_head(job.theta);
}

/// From 0. The other axes stand.
void DynamicGantry::turn_head(double theta)
{
    const Drive& c = machine_.c;
    if (!(theta >= c.least && theta <= c.most))
        throw InputError(machine_.source,
                         "axes.c cannot turn to " + to_short_text(theta * 180 / std::numbers::pi) + "°");
    ServoAxis axis(c, 0, 0, machine_.period, 0);
    Reference reference;
    const double direction = theta < 0 ? -1 : 1;
    const auto settled = [&] {
        return reference.p == theta && std::abs(axis.measured() - theta) <= kSettled * c.encoder;
    };
    for (double waited = 0; !settled() && waited < kMostSettling;) {
        const double rest = direction * (theta - reference.p), speed = direction * reference.v;
        const double next = std::min({speed + c.acceleration * machine_.period, c.speed,
                                      speed_to_stop(rest, speed, c.acceleration, machine_.period)});
        const bool there = rest <= c.acceleration * machine_.period * machine_.period;
        reference.a = there ? 0 : direction * (next - speed) / machine_.period;
        axis.step(reference, 0);
        reference.p = there ? theta : reference.p + direction * (speed + next) / 2 * machine_.period;
        reference.v = there ? 0 : direction * next;
        if (there) waited += machine_.period;
        spend(machine_.period, totals_.travel_time);
    }
}

GantryStatus DynamicGantry::travel(const Eigen::Vector3d& tool_point)
{
    check_range(tool_point);
    begin_move();
    account_ = &totals_.travel_time;
    go_to_safe_height();
    const double across = std::min(machine_.axes[0].speed, machine_.axes[1].speed);
    run_to({tool_point.x(), tool_point.y(), reference_.p.z()}, across, false);
    return lift(tool_point.z());
}

GantryStatus DynamicGantry::lift(double commanded_z)
{
    check_range({reference_.p.x(), reference_.p.y(), commanded_z});
    begin_move();
    account_ = &totals_.travel_time;
    halt();
    if (commanded_z > reference_.p.z())
        run_to({reference_.p.x(), reference_.p.y(), commanded_z}, machine_.axes[2].speed, false);
    else
        down_to(commanded_z);
    line_end_ = reference_.p;
    return status_;
}

GantryStatus DynamicGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    check_positive(feed, "feed");
    check_range(tool_point);
    begin_move();
    account_ = &totals_.grinding_time;
    const Eigen::Vector3d way = tool_point - line_end_;
    const double length = way.norm();
    if (length == 0) return status_;
    const Eigen::Vector3d along = way / length;
    const double most = acceleration_ * machine_.period;
    while ((reference_.p - tool_point).dot(along) < 0) {
        const Eigen::Vector3d change = along_line(reference_.p - line_end_, along, feed) - reference_.v;
        const double size = change.norm();
        move_reference(reference_.v + (size > most ? change * (most / size) : change));
    }
    line_end_ = tool_point;
    totals_.grinding_length += length;
    return status_;
}

/// The speed at which the command goes on along a line, and back to it.
Eigen::Vector3d DynamicGantry::along_line(const Eigen::Vector3d& off, const Eigen::Vector3d& along, double feed) const
{
    const double back = std::max(feed / acceleration_, kLeastPeriods * machine_.period);
    return feed * along - (off - off.dot(along) * along) / back;
}

GantryStatus DynamicGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    check_positive(feed, "feed");
    check_range(tool_point);
    begin_move();
    account_ = &totals_.grinding_time;
    const auto level = [](Eigen::Vector3d v) { return Eigen::Vector3d(v.x(), v.y(), 0); };
    const Eigen::Vector3d way = level(tool_point - line_end_);
    const double length = way.norm();
    if (length == 0) return status_;
    const Eigen::Vector3d along = way / length;
    const double most = acceleration_ * machine_.period;
    const double wanted = std::max(force - spring_.preload, 0.0) / spring_.stiffness;
    if (!force_loop_) come_down(tool_point.z(), wanted);
    while (level(reference_.p - tool_point).dot(along) < 0) {
        const Eigen::Vector3d change = along_line(level(reference_.p - line_end_), along, feed) - level(reference_.v);
        Eigen::Vector3d next = level(reference_.v) + change * std::min(1.0, most / std::max(change.norm(), most / 2));
        next.z() = hold(tool_point.z(), wanted);
        move_reference(next);
    }
    line_end_ << tool_point.head<2>(), reference_.p.z();
    totals_.grinding_length += length;
    return status_;
}

/// In place, until the part is felt.
void DynamicGantry::come_down(double lowest, double wanted)
{
    const Drive& z = machine_.axes[2];
    force_loop_.emplace(force_gains_, machine_.period, z.speed, z.acceleration);
    while (status_.deflection < kFelt * wanted && reference_.p.z() > lowest + z.encoder)
        move_reference({0, 0, hold(lowest, wanted)});
    line_end_ = reference_.p;
}

/// The speed of Z that holds the deflection. Until it touches, and above its lowest place, no faster than it can stop.
double DynamicGantry::hold(double lowest, double wanted)
{
    const double rest = std::max(reference_.p.z() - lowest, 0.0), sinking = std::max(-reference_.v.z(), 0.0);
    const double stop = std::max(speed_to_stop(rest, sinking, acceleration_, machine_.period), 0.0);
    const double search = touching_speed(kGentle * spring_.stiffness * wanted);
    const double fastest = status_.deflection > kFelt * wanted ? machine_.axes[2].speed : search;
    return force_loop_->step(wanted, status_.deflection, reference_.v.z(), std::min(fastest, stop));
}

protocol::Limits DynamicGantry::limits() const
{
    const auto& [x, y, z] = machine_.axes;
    return {{x.least, y.least, z.least},
            {x.most, y.most, z.most},
            Eigen::Vector3d(x.speed, y.speed, z.speed).norm(),
            spring_.force(machine_.head.travel)};
}

void DynamicGantry::check_range(const Eigen::Vector3d& tool_point) const
{
    for (int k = 0; k < 3; ++k) {
        const Drive& drive = machine_.axes[static_cast<std::size_t>(k)];
        if (tool_point[k] >= drive.least && tool_point[k] <= drive.most) continue;
        throw InputError(machine_.source, std::string("axes.") + "xyz"[k] + " goes from " + to_short_text(drive.least) +
                                              " to " + to_short_text(drive.most) + " mm; the work needs " +
                                              to_short_text(tool_point[k]));
    }
}

/// To rest, straight on.
void DynamicGantry::halt()
{
    force_loop_.reset();
    while (reference_.v.squaredNorm() > 0) {
        const double speed = reference_.v.norm();
        move_reference(reference_.v * std::max(0.0, 1 - acceleration_ * machine_.period / speed));
    }
}

/// From rest to rest in a straight line. A guarded move stops when the force at its end would reach F_max.
void DynamicGantry::run_to(const Eigen::Vector3d& target, double speed, bool guarded)
{
    const double a = acceleration_, period = machine_.period;
    const double length = (target - reference_.p).norm();
    if (length == 0) return;
    const Eigen::Vector3d along = (target - reference_.p) / length;
    for (double v = 0;;) {
        const double rest = (target - reference_.p).dot(along);
        if (rest <= a * period * period) break;
        const double ahead = spring_.stiffness * v * (v / (2 * a) + period);
        const bool stop = guarded && status_.force + ahead >= most_force_;
        v = stop ? std::max(v - a * period, 0.0) : std::min({v + a * period, speed, speed_to_stop(rest, v, a, period)});
        move_reference(v * along);
        if (stop && v == 0) break;
    }
    halt();
    if ((target - reference_.p).dot(along) <= a * period * period) reference_.p = target;
    const auto settled = [&] {
        for (int k = 0; k < 3; ++k) {
            const auto n = static_cast<std::size_t>(k);
            if (std::abs(axes_[n].measured() - reference_.p[k]) > kSettled * machine_.axes[n].encoder) return false;
        }
        return true;
    };
    for (double waited = 0; !settled() && waited < kMostSettling; waited += period) move_reference({0, 0, 0});
}

/// From which the drives stop before the spring has that force.
double DynamicGantry::touching_speed(double force) const
{
    return std::sqrt(2 * acceleration_ * kTouchShare * force / spring_.stiffness);
}

void DynamicGantry::down_to(double z)
{
    run_to({reference_.p.x(), reference_.p.y(), z}, std::min(machine_.axes[2].speed, touching_speed(most_force_)),
           true);
}

void DynamicGantry::go_to_safe_height()
{
    account_ = &totals_.travel_time;
    halt();
    const Eigen::Vector3d up(reference_.p.x(), reference_.p.y(), std::max(safe_height_, reference_.p.z()));
    run_to(up, machine_.axes[2].speed, false);
    line_end_ = reference_.p;
}

/// One period, at whose end the command moves at `velocity`.
void DynamicGantry::move_reference(const Eigen::Vector3d& velocity)
{
    reference_.a = (velocity - reference_.v) / machine_.period;
    tick();
    reference_.p += (reference_.v + velocity) / 2 * machine_.period;
    reference_.v = velocity;
}

void DynamicGantry::tick()
{
    const double period = machine_.period;
    const auto reference = [&](int k) { return Reference{reference_.p[k], reference_.v[k], reference_.a[k]}; };
    for (const int k : {0, 1}) axes_[static_cast<std::size_t>(k)].step(reference(k), push_[k]);
    if (deflection_ > 0) {
        axes_[2].step_with_spring(reference(2), spring_.preload, tip_, tip_rate_);
        tip_ += tip_rate_ * period;
    } else {
        axes_[2].step(reference(2), stop_force_);
        tip_ = nut();
    }
    spend(period, *account_);
    ++since_;
    check_following();
    if (contact_due()) meet();
    measure();
}

void DynamicGantry::check_following() const
{
    for (int k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(k);
        const double lag = std::abs(reference_.p[k] - axes_[n].measured());
        if (lag > machine_.axes[n].following_error)
            throw GantryFault(std::string("the drive of axis ") + "xyz"[k] + " is switched off: " + to_short_text(lag) +
                              " mm from its command at " + to_short_text(status_.time) + " s");
    }
}

/// The transducer sees the spring, not the force at the stop.
void DynamicGantry::measure()
{
    double seen = std::max(tip_ - nut(), 0.0);
    if (machine_.head.noise > 0) { // Box and Muller 1958
        const auto uniform = [&] { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; };
        const double u = uniform(), v = uniform();
        seen += machine_.head.noise * std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    }
    seen = std::max(std::round(seen / machine_.head.lvdt) * machine_.head.lvdt, 0.0);
    status_.deflection = seen;
    status_.force = seen > 0 ? spring_.force(seen) : 0;
    status_.peak_force = std::max(status_.peak_force, status_.force);
    for (int k = 0; k < 3; ++k) status_.commanded[k] = axes_[static_cast<std::size_t>(k)].measured();
}

} // namespace fettle
