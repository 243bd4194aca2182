#include "gantry/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle {
namespace {

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
    : VirtualGantry(std::move(stock), job, options, {}), rapid_(options.rapid), lift_speed_(options.lift_speed)
{
    check_positive(rapid_, "rapid speed");
    check_positive(lift_speed_, "lift speed");
}

GantryStatus QuasiStaticGantry::travel(const Eigen::Vector3d& tool_point)
{
    begin_move();
    go_to_safe_height();
    const double across = (tool_point - status_.commanded).head<2>().norm();
    spend(across / rapid_, totals_.travel_time);
    status_.commanded.head<2>() = tool_point.head<2>();
    if (tool_point.z() > status_.commanded.z()) raise_to(tool_point.z());
    lower_to(tool_point.z());
    return status_;
}

GantryStatus QuasiStaticGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    check_positive(feed, "feed");
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

protocol::Limits QuasiStaticGantry::limits() const
{
    constexpr double kFar = 1e4;       // ten metres: each millimetre of a move is computed, and somebody waits for it
    constexpr double kUnlimited = 1e6; // mm/s and N
    return {Eigen::Vector3d::Constant(-kFar), Eigen::Vector3d::Constant(kFar), kUnlimited, kUnlimited};
}

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
        const double duration = (next.z() - status_.commanded.z()) / lift_speed_;
        press_for(next, duration);
        spend(duration, totals_.travel_time);
    }
    spend((z - status_.commanded.z()) / lift_speed_, totals_.travel_time);
    status_.commanded.z() = z;
}

/// Down to the first touch at once, then in steps, until there or F_max is reached.
void QuasiStaticGantry::lower_to(double z)
{
    const Eigen::Vector2d xy = R_working_machine_ * status_.commanded.head<2>();
    wheel_.place(xy, radius_, z + loss());
    const double free = std::clamp(wheel_.touch() - loss(), z, std::max(z, status_.commanded.z()));
    spend((status_.commanded.z() - free) / lift_speed_, totals_.travel_time);
    status_.commanded.z() = free;

    const double step = options_.substep * stock_.cell;
    while (status_.commanded.z() > z && status_.force < most_force_) {
        Eigen::Vector3d next = status_.commanded;
        next.z() = std::max(next.z() - step, z);
        const double duration = (status_.commanded.z() - next.z()) / lift_speed_;
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
    const Balance balance = fettle::press(wheel_, spring_, z_stop, c_dt, z_stop + status_.deflection + bending_);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    status_.commanded = commanded;
    bending_ = balance.z_tip - z_stop - status_.deflection;
    status_.deflection = balance.z_tip - z_stop;
    status_.force = balance.force;
    status_.peak_force = std::max(status_.peak_force, balance.force);
    wear(balance.volume);
}

} // namespace fettle
