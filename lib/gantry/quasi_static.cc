#include "gantry/quasi_static.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fettle {
namespace {

void check(double value, const char* name)
{
    if (!(value > 0)) throw InputError("gantry", std::string(name) + " must be positive, not " + to_text(value));
}

/// A length that is a whole number of steps but for rounding gets no step more.
constexpr double kWholeStep = 1e-6;

/// Fractions of a move, ascending, the last one 1.
std::vector<double> equal_steps(double length, double step)
{
    const int count = std::max(1, static_cast<int>(std::ceil(length / step - kWholeStep)));
    std::vector<double> ends;
    for (int n = 1; n <= count; ++n) ends.push_back(static_cast<double>(n) / count);
    return ends;
}

/// Fractions of a move from x0 to x1 where it crosses multiples of `step`.
std::vector<double> aligned_steps(double x0, double x1, double step)
{
    const double direction = x1 > x0 ? 1 : -1, from = direction * x0 / step, to = direction * x1 / step;
    std::vector<double> ends;
    for (double m = std::floor(from + kWholeStep) + 1; m <= to + kWholeStep; ++m)
        ends.push_back(std::min((m - from) / (to - from), 1.0));
    return ends;
}

} // namespace

QuasiStaticGantry::QuasiStaticGantry(HeightField stock, const Job& job, const QuasiStaticOptions& options)
    : stock_(std::move(stock)), wheel_(stock_, job.wheel.width), spring_{job.force.preload, job.force.stiffness},
      options_(options), R_working_machine_(rotation_working_machine(job.theta)), removal_(job.removal),
      new_radius_(job.wheel.radius), width_(job.wheel.width), safe_height_(job.safe_height), most_force_(job.force.max),
      radius_(new_radius_), known_radius_(new_radius_)
{
    check(options_.rapid, "rapid speed");
    check(options_.lift_speed, "lift speed");
    check(options_.touch_off_resolution, "touch-off resolution");
    check(options_.grinding_ratio, "grinding ratio");
    check(options_.substep, "step");
    const Eigen::Vector2d middle = (stock_.centre(0, 0) + stock_.centre(stock_.columns() - 1, stock_.rows() - 1)) / 2;
    status_.commanded << R_working_machine_.transpose() * middle, safe_height_;
}

GantryStatus QuasiStaticGantry::travel(const Eigen::Vector3d& tool_point)
{
    begin_move();
    go_to_safe_height();
    const double across = (tool_point - status_.commanded).head<2>().norm();
    spend(across / options_.rapid, totals_.travel_time);
    status_.commanded.head<2>() = tool_point.head<2>();
    if (tool_point.z() > status_.commanded.z()) raise_to(tool_point.z());
    lower_to(tool_point.z());
    return status_;
}

GantryStatus QuasiStaticGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    check(feed, "feed");
    begin_move();
    const Eigen::Vector3d start = status_.commanded, way = tool_point - start;
    const double length = way.norm();
    if (length == 0) return status_;
    double last = 0;
    for (const double end : sub_steps(start, tool_point)) {
        press_for(start + end * way, (end - last) * length / feed);
        last = end;
    }
    pending_ += (1 - last) * length / feed;
    status_.commanded = tool_point;
    spend(length / feed, totals_.grinding_time);
    totals_.grinding_length += length;
    return status_;
}

/// A wheel that moves along its axis meets column after column with its face: its sub-steps end where the face stands
/// between columns, or the force would jump with the number of columns in a sub-step. Across its axis the rim meets the
/// rows smoothly.
std::vector<double> QuasiStaticGantry::sub_steps(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const
{
    const double step = options_.substep * stock_.cell;
    const Eigen::Vector2d way = R_working_machine_ * (end - start).head<2>();
    if (std::abs(way.x()) <= std::abs(way.y())) return equal_steps((end - start).norm(), step);
    const double face = std::copysign(width_ / 2, way.x()) - stock_.origin.x();
    const double x = R_working_machine_.row(0) * start.head<2>() + face;
    return aligned_steps(x, x + way.x(), std::ceil(options_.substep) * stock_.cell);
}

GantryStatus QuasiStaticGantry::lift(double commanded_z)
{
    begin_move();
    if (commanded_z > status_.commanded.z()) raise_to(commanded_z);
    lower_to(commanded_z);
    return status_;
}

double QuasiStaticGantry::touch_off()
{
    begin_move();
    go_to_safe_height();
    spend(options_.touch_off_time, totals_.service_time);
    ++totals_.touch_offs;
    known_radius_ = std::round(radius_ / options_.touch_off_resolution) * options_.touch_off_resolution;
    return known_radius_;
}

void QuasiStaticGantry::change_wheel()
{
    begin_move();
    go_to_safe_height();
    spend(options_.wheel_change_time, totals_.service_time);
    ++totals_.wheel_changes;
    radius_ = known_radius_ = new_radius_;
}

void QuasiStaticGantry::begin_move() { status_.peak_force = status_.force; }

void QuasiStaticGantry::go_to_safe_height()
{
    if (safe_height_ > status_.commanded.z()) raise_to(safe_height_);
}

/// The spring is relieved on the way; what the wheel grinds in these milliseconds counts.
void QuasiStaticGantry::raise_to(double z)
{
    const double step = options_.substep * stock_.cell;
    while (status_.force > 0 && status_.commanded.z() < z) {
        Eigen::Vector3d next = status_.commanded;
        next.z() = std::min(next.z() + step, z);
        const double duration = (next.z() - status_.commanded.z()) / options_.lift_speed;
        press_for(next, duration);
        spend(duration, totals_.travel_time);
    }
    spend((z - status_.commanded.z()) / options_.lift_speed, totals_.travel_time);
    status_.commanded.z() = z;
}

/// Down to the first touch at once, then in steps, until there or F_max is reached.
void QuasiStaticGantry::lower_to(double z)
{
    const Eigen::Vector2d xy = R_working_machine_ * status_.commanded.head<2>();
    wheel_.place(xy, radius_, z + loss());
    const double free = std::clamp(wheel_.touch() - loss(), z, std::max(z, status_.commanded.z()));
    spend((status_.commanded.z() - free) / options_.lift_speed, totals_.travel_time);
    status_.commanded.z() = free;

    const double step = options_.substep * stock_.cell;
    while (status_.commanded.z() > z && status_.force < most_force_) {
        Eigen::Vector3d next = status_.commanded;
        next.z() = std::max(next.z() - step, z);
        const double duration = (status_.commanded.z() - next.z()) / options_.lift_speed;
        press_for(next, duration);
        spend(duration, totals_.travel_time);
    }
}

void QuasiStaticGantry::press_for(const Eigen::Vector3d& commanded, double duration)
{
    const double z_stop = commanded.z() + loss();
    wheel_.place(R_working_machine_ * commanded.head<2>(), radius_, z_stop);
    const double c_dt = removal_ * (duration + std::exchange(pending_, 0));
    // The head mostly bends on as it did: that guess saves every fifth look at the cells.
    const Balance balance = press(wheel_, spring_, z_stop, c_dt, z_stop + status_.deflection + bending_);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    status_.commanded = commanded;
    bending_ = balance.z_tip - z_stop - status_.deflection;
    status_.deflection = balance.z_tip - z_stop;
    status_.force = balance.force;
    status_.peak_force = std::max(status_.peak_force, balance.force);
    wear(balance.volume);
}

/// The rim loses its share: dV_wheel = 2πR w dR.
void QuasiStaticGantry::wear(double removed_volume)
{
    totals_.removed_volume += removed_volume;
    radius_ -= removed_volume / options_.grinding_ratio / (2 * std::numbers::pi * radius_ * width_);
    if (!(radius_ > 0))
        throw InputError("gantry", "the wheel is worn away after " + to_text(totals_.removed_volume) +
                                       " mm³; it was not changed in time");
}

void QuasiStaticGantry::spend(double duration, double& account)
{
    account += duration;
    status_.time += duration;
}

} // namespace fettle
