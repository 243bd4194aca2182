#include "strategy/recorder.h"

#include "core/error.h"

#include <utility>

namespace fettle::strategy {
namespace {

/// A coordinate, and the value of a field, rounded as a trace file of this unit stores them.
double stored_coordinate(double value, double unit) { return double(float(value / unit)) * unit; }
double stored_value(double value, double unit)
{
    const auto written = float(double(float(value)) / unit);
    return float(double(written) * unit);
}

} // namespace

Recorder::Recorder(gantry::Gantry& gantry, const units::Units& units, std::vector<TraceRow> history,
                   const std::string& source, TraceFile* journal)
    : gantry_(gantry), units_(units), history_(std::move(history)), source_(source), journal_(journal),
      live_(history_.empty()), status_(gantry.status())
{
}

void Recorder::go_live()
{
    live_ = true;
    time_offset_ = status_.time - gantry_.status().time;
}

const gantry::GantryStatus& Recorder::travel(const Mark& mark, const Eigen::Vector3d& tool_point)
{
    return act(mark, tool_point, 0, [&] { set_status(gantry_.travel(tool_point)); });
}

const gantry::GantryStatus& Recorder::travel_low(const Mark& mark, const Eigen::Vector3d& tool_point, double over,
                                                 double free)
{
    return act(mark, tool_point, 0, [&] { set_status(gantry_.travel_low(tool_point, over, free)); });
}

const gantry::GantryStatus& Recorder::grind(const Mark& mark, const Eigen::Vector3d& tool_point, double feed)
{
    return act(mark, tool_point, feed, [&] { set_status(gantry_.grind(tool_point, feed)); });
}

const gantry::GantryStatus& Recorder::press(const Mark& mark, const Eigen::Vector3d& tool_point, double feed,
                                            double force)
{
    return act(mark, tool_point, feed, [&] { set_status(gantry_.press(tool_point, feed, force)); });
}

const gantry::GantryStatus& Recorder::lift(const Mark& mark, double commanded_z)
{
    const Eigen::Vector3d target(status_.commanded.x(), status_.commanded.y(), commanded_z);
    return act(mark, target, 0, [&] { set_status(gantry_.lift(commanded_z)); });
}

void Recorder::retract(const Mark& mark, double safe_height)
{
    set_status(gantry::retract(gantry_, safe_height));
    record(mark, 0);
    lift(mark, safe_height);
}

double Recorder::touch_off(const Mark& mark)
{
    act(mark, status_.commanded, 0, [&] {
        radius_ = gantry_.touch_off() / units_.mm() * units_.mm();
        set_status(gantry_.status());
    });
    return radius_;
}

void Recorder::change_wheel(const Mark& mark)
{
    act(mark, status_.commanded, 0, [&] {
        gantry_.change_wheel();
        set_status(gantry_.status());
    });
}

void Recorder::record_decision(const Mark& mark)
{
    if (!live_ && !replay_ended()) return replay(mark, 0);
    record(mark, 0);
}

void Recorder::record_fault(const Mark& mark)
try {
    record(mark, 0);
} catch (const gantry::GantryFault&) { // the trace has the row
}

template <class Work>
const gantry::GantryStatus& Recorder::act(const Mark& mark, const Eigen::Vector3d& target, double feed,
                                          const Work& work)
{
    if (replay_ended()) go_live();
    if (!live_) {
        replay(mark, feed);
        return status_;
    }
    write_journal([&](TraceFile& journal) {
        journal.begin_row({.time = status_.time,
                           .tool = target,
                           .layer = mark.layer,
                           .pass = mark.pass,
                           .event = Event::in_progress,
                           .feed = feed});
    });
    work();
    record(mark, feed);
    return status_;
}

void Recorder::replay(const Mark& mark, double feed)
{
    const TraceRow& row = history_[next_++];
    if (row.layer != mark.layer || row.pass != mark.pass || row.event != mark.event || (row.feed > 0) != (feed > 0))
        throw core::InputError(source_, "point " + std::to_string(next_) +
                                            " does not match this plan and these options: it belongs to another run");
    status_ = {row.time, row.tool - row.deflection * Eigen::Vector3d::UnitZ(), row.deflection, row.force,
               row.peak_force};
    radius_ = row.radius;
    trace_.push_back(row);
}

void Recorder::set_status(const gantry::GantryStatus& status)
{
    const double mm = units_.mm(), newton = units_.newton();
    const double tip = stored_coordinate(status.commanded.z() + status.deflection, mm);
    status_.time = status.time + time_offset_;
    status_.deflection = stored_value(status.deflection, mm);
    status_.commanded << stored_coordinate(status.commanded.x(), mm), stored_coordinate(status.commanded.y(), mm),
        tip - status_.deflection;
    status_.force = stored_value(status.force, newton);
    status_.peak_force = stored_value(status.peak_force, newton);
}

void Recorder::record(const Mark& mark, double feed)
{
    trace_.push_back({.time = status_.time,
                      .tool = status_.commanded + status_.deflection * Eigen::Vector3d::UnitZ(),
                      .layer = mark.layer,
                      .pass = mark.pass,
                      .event = mark.event,
                      .force = status_.force,
                      .feed = feed,
                      .peak_force = status_.peak_force,
                      .deflection = status_.deflection,
                      .radius = radius_});
    write_journal([this](TraceFile& journal) { journal.complete_row(trace_.back()); });
}

/// A journal that cannot be written stays as it is, and the run ends.
template <class Write>
void Recorder::write_journal(const Write& write)
{
    if (journal_ == nullptr) return;
    try {
        write(*journal_);
    } catch (const core::InputError& error) {
        journal_ = nullptr;
        throw gantry::GantryFault(error.what() + std::string("; stopped"));
    }
}

} // namespace fettle::strategy
