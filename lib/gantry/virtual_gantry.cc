#include "gantry/virtual_gantry.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace fettle::gantry {
namespace {

// How often a machine that works in one place looks whether it has to stop, s: an operator's stop has 0.25 s, most of
// which the drives take.
constexpr double kStopPeriod = 0.05;

} // namespace

void check_positive(double value, const char* name)
{
    if (!(value > 0))
        throw core::InputError("gantry", std::string(name) + " must be positive, not " + core::to_text(value));
}

VirtualGantry::VirtualGantry(removal::HeightField stock, const job::Job& job, const VirtualOptions& options,
                             const removal::RimForce& rim)
    : stock_(std::move(stock)), wheel_(stock_, job.wheel.width, rim), spring_{job.force.preload, job.force.stiffness},
      options_(options), R_working_machine_(job::rotation_working_machine(job.theta)),
      removal_(job.removal_coefficient * options.removal_factor),
      grinding_ratio_(options.grinding_ratio.value_or(job.wheel.grinding_ratio.value_or(kUsualGrindingRatio))),
      new_radius_(job.wheel.radius), width_(job.wheel.width), safe_height_(job.safe_height),
      tip_radius_(job.probe.tip_radius), max_force_(job.force.max), radius_(new_radius_), measured_radius_(new_radius_)
{
    check_positive(options_.touch_resolution, "resolution of a touch");
    check_positive(grinding_ratio_, "grinding ratio");
    check_positive(options_.removal_factor, "removal factor");
    check_positive(options_.substep, "step");
    const Eigen::Vector2d middle = (stock_.centre(0, 0) + stock_.centre(stock_.columns() - 1, stock_.rows() - 1)) / 2;
    status_.commanded << R_working_machine_.transpose() * middle, safe_height_;
}

double VirtualGantry::touch_off()
{
    begin_move();
    go_to_safe_height();
    serve(options_.touch_off_time);
    ++totals_.touch_offs;
    measured_radius_ = round_to_resolution(radius_);
    return measured_radius_;
}

double VirtualGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    travel({xy.x(), xy.y(), safe_height_});
    const double height = removal::height_under_ball(stock_, R_working_machine_ * xy, tip_radius_);
    const bool touched = height >= lowest;
    const sampling::ProbingMachine& speeds = options_.probing;
    const double depth = safe_height_ - (touched ? height : lowest);
    serve(depth / speeds.approach_speed + depth / speeds.travel_speed + speeds.dwell);
    return touched ? round_to_resolution(height) : std::numeric_limits<double>::quiet_NaN();
}

void VirtualGantry::turn_to(double theta)
{
    if (theta != stock_.theta) throw GantryFault("the head stands at " + core::to_text(stock_.theta) + " rad");
}

double VirtualGantry::round_to_resolution(double length) const
{
    return std::round(length / options_.touch_resolution) * options_.touch_resolution;
}

void VirtualGantry::change_wheel()
{
    begin_move();
    go_to_safe_height();
    serve(options_.wheel_change_time);
    ++totals_.wheel_changes;
    radius_ = measured_radius_ = new_radius_;
}

/// dV_wheel = 2πR w dR.
void VirtualGantry::wear(double removed_volume)
{
    totals_.removed_volume += removed_volume;
    radius_ -= removed_volume / grinding_ratio_ / (2 * std::numbers::pi * radius_ * width_);
    if (!(radius_ > 0))
        throw core::InputError("gantry", "the wheel is worn away after " + core::to_text(totals_.removed_volume) +
                                             " mm³; it was not changed in time");
}

void VirtualGantry::advance_time(double duration, TimeBucket bucket)
{
    double& total = bucket == TimeBucket::grinding ? totals_.grinding_time
                    : bucket == TimeBucket::travel ? totals_.travel_time
                                                   : totals_.service_time;
    total += duration;
    status_.time += duration;
}

void VirtualGantry::serve(double duration)
{
    const double begin = status_.time;
    // The times asked at are counted from the beginning, so that what is not stopped takes the same time to the last
    // bit.
    for (int period = 1; period * kStopPeriod < duration; ++period) {
        status_.time = begin + period * kStopPeriod;
        const bool stopped = is_interrupted();
        status_.time = begin;
        if (!stopped) continue;
        advance_time(period * kStopPeriod, TimeBucket::service);
        throw Interrupted();
    }
    advance_time(duration, TimeBucket::service);
}

void add_report(json::Value& report, const GrindTotals& totals)
{
    report.set("grinding_time", totals.grinding_time)
        .set("travel_time", totals.travel_time)
        .set("service_time", totals.service_time);
}

} // namespace fettle::gantry
