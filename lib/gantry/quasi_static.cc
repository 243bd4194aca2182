#include "gantry/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::gantry {
namespace {

/// A length that exceeds a whole number of steps by less gets no additional step.
constexpr double kStepCountTolerance = 1e-6;
/// A guarded descent slows down towards F_max, to this share of a step.
constexpr double kMinGuardedShare = 0.1;

/// Fractions of a move, ascending, the last one 1.
std::vector<double> equal_steps(double length, double step)
{
    const int count = std::max(1, int(std::ceil(length / step - kStepCountTolerance)));
    std::vector<double> ends;
    for (int n = 1; n <= count; ++n) ends.push_back(double(n) / count);
    return ends;
}

/// Fractions of a move from x0 to x1 where it crosses multiples of `step`.
std::vector<double> aligned_steps(double x0, double x1, double step)
{
    const double direction = x1 > x0 ? 1 : -1, from = direction * x0 / step, to = direction * x1 / step;
    std::vector<double> ends;
    for (double m = std::floor(from + kStepCountTolerance) + 1; m <= to + kStepCountTolerance; ++m)
        ends.push_back(std::min((m - from) / (to - from), 1.0));
    return ends;
}

} // namespace

QuasiStaticGantry::QuasiStaticGantry(removal::HeightField stock, const job::Job& job, const QuasiStaticOptions& options)
    : VirtualGantry(std::move(stock), job, options, {}), rapid_(options.rapid), lift_speed_(options.lift_speed)
{
    check_positive(rapid_, "rapid speed");
    check_positive(lift_speed_, "lift speed");
}

GantryStatus QuasiStaticGantry::travel(const Eigen::Vector3d& tool_point)
{
    return travel_low(tool_point, safe_height_, safe_height_);
}

/// The drives lower the wheel at one speed, free or guarded.
GantryStatus QuasiStaticGantry::travel_low(const Eigen::Vector3d& tool_point, double over, double /*free*/)
{
    begin_move();
    if (over > status_.commanded.z()) raise_to(over);
    const double across = (tool_point - status_.commanded).head<2>().norm();
    advance_time(across / rapid_, TimeBucket::travel);
    status_.commanded.head<2>() = tool_point.head<2>();
    if (tool_point.z() > status_.commanded.z()) raise_to(tool_point.z());
    lower_to(tool_point.z());
    return status_;
}

GantryStatus QuasiStaticGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    check_positive(feed, "feed");
    begin_move();
    const Eigen::Vector3d start = status_.commanded, motion = tool_point - start;
    const double length = motion.norm();
    if (length == 0) return status_;
    double last = 0;
    for (const double end : sub_steps(start, tool_point)) {
        press_for(start + end * motion, (end - last) * length / feed);
        last = end;
    }
    pending_time_ += (1 - last) * length / feed;
    status_.commanded = tool_point;
    advance_time(length / feed, TimeBucket::grinding);
    totals_.grinding_length += length;
    return status_;
}

/// The side face of a wheel that moves along its axis meets the stock column by column: the sub-steps end where the
/// face is between columns, or the force would jump with the number of columns in a sub-step. Across its axis the rim
/// meets the rows smoothly.
std::vector<double> QuasiStaticGantry::sub_steps(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const
{
    const double step = options_.substep * stock_.cell;
    const Eigen::Vector2d motion = R_working_machine_ * (end - start).head<2>();
    if (std::abs(motion.x()) <= std::abs(motion.y())) return equal_steps((end - start).norm(), step);
    const double face = std::copysign(width_ / 2, motion.x()) - stock_.origin.x();
    const double x = R_working_machine_.row(0) * start.head<2>() + face;
    return aligned_steps(x, x + motion.x(), std::ceil(options_.substep) * stock_.cell);
}

GantryStatus QuasiStaticGantry::lift(double commanded_z)
{
    begin_move();
    if (commanded_z > status_.commanded.z()) raise_to(commanded_z);
    lower_to(commanded_z);
    return status_;
}

protocol::Limits QuasiStaticGantry::limits() const
{
    constexpr double kMaxCoordinate = 1e4;    // mm; larger moves would take long to simulate
    constexpr double kMaxSpeedAndForce = 1e6; // mm/s and N
    return {Eigen::Vector3d::Constant(-kMaxCoordinate), Eigen::Vector3d::Constant(kMaxCoordinate), kMaxSpeedAndForce,
            kMaxSpeedAndForce};
}

void QuasiStaticGantry::go_to_safe_height()
{
    if (safe_height_ > status_.commanded.z()) raise_to(safe_height_);
}

/// The spring relaxes on the way up; what the wheel grinds in these milliseconds counts.
void QuasiStaticGantry::raise_to(double z)
{
    while (status_.force > 0 && status_.commanded.z() < z) sub_step_towards(z, options_.substep * stock_.cell);
    advance_time((z - status_.commanded.z()) / lift_speed_, TimeBucket::travel);
    status_.commanded.z() = z;
}

/// Descends to the first touch at once, then in steps, until z or F_max is reached.
void QuasiStaticGantry::lower_to(double z)
{
    const Eigen::Vector2d xy = R_working_machine_ * status_.commanded.head<2>();
    wheel_.place(xy, radius_, z + wheel_wear());
    const double free = std::clamp(wheel_.touch() - wheel_wear(), z, std::max(z, status_.commanded.z()));
    advance_time((status_.commanded.z() - free) / lift_speed_, TimeBucket::travel);
    status_.commanded.z() = free;
    while (status_.commanded.z() > z && status_.force < max_force_) {
        const double room = (max_force_ - status_.force) / spring_.stiffness, step = options_.substep * stock_.cell;
        sub_step_towards(z, std::clamp(room, kMinGuardedShare * step, step));
    }
}

void QuasiStaticGantry::sub_step_towards(double z, double step)
{
    const double from = status_.commanded.z();
    Eigen::Vector3d next = status_.commanded;
    next.z() = std::clamp(z, from - step, from + step);
    const double duration = std::abs(next.z() - from) / lift_speed_;
    press_for(next, duration);
    advance_time(duration, TimeBucket::travel);
}

void QuasiStaticGantry::press_for(const Eigen::Vector3d& commanded, double duration)
{
    const double z_stop = commanded.z() + wheel_wear();
    wheel_.place(R_working_machine_ * commanded.head<2>(), radius_, z_stop);
    const double c_dt = removal_ * (duration + std::exchange(pending_time_, 0));
    // The deflection mostly changes as it did before: this guess saves a fifth of the iterations.
    const removal::Balance balance =
        fettle::removal::press(wheel_, spring_, z_stop, c_dt, z_stop + status_.deflection + deflection_change_);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    status_.commanded = commanded;
    deflection_change_ = balance.z_tip - z_stop - status_.deflection;
    status_.deflection = balance.z_tip - z_stop;
    status_.force = balance.force;
    status_.peak_force = std::max(status_.peak_force, balance.force);
    wear(balance.volume);
}

} // namespace fettle::gantry
