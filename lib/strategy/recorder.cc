#include "strategy/recorder.h"

#include "core/error.h"

#include <utility>

namespace fettle {
namespace {

/// A coordinate, and the value of a field, as they come back from a trace in a file of this unit.
double held_place(double value, double unit) { return static_cast<double>(static_cast<float>(value / unit)) * unit; }
double held(double value, double unit)
{
    const auto written = static_cast<float>(static_cast<double>(static_cast<float>(value)) / unit);
    return static_cast<float>(static_cast<double>(written) * unit);
}

} // namespace

Recorder::Recorder(Gantry& gantry, const Units& units, std::vector<TraceRow> done, const std::string& source,
                   TraceFile* journal)
    : gantry_(gantry), units_(units), done_(std::move(done)), source_(source), journal_(journal), live_(done_.empty()),
      status_(gantry.status())
{
}

void Recorder::go_live()
{
    live_ = true;
    later_ = status_.time - gantry_.status().time;
}

const GantryStatus& Recorder::travel(const Mark& mark, const Eigen::Vector3d& tool_point)
{
    return act(mark, tool_point, 0, [&] { tell(gantry_.travel(tool_point)); });
}

const GantryStatus& Recorder::grind(const Mark& mark, const Eigen::Vector3d& tool_point, double feed)
{
    return act(mark, tool_point, feed, [&] { tell(gantry_.grind(tool_point, feed)); });
}

const GantryStatus& Recorder::press(const Mark& mark, const Eigen::Vector3d& tool_point, double feed, double force)
{
    return act(mark, tool_point, feed, [&] { tell(gantry_.press(tool_point, feed, force)); });
}

const GantryStatus& Recorder::lift(const Mark& mark, double commanded_z)
{
    const Eigen::Vector3d target(status_.commanded.x(), status_.commanded.y(), commanded_z);
    return act(mark, target, 0, [&] { tell(gantry_.lift(commanded_z)); });
}

double Recorder::touch_off(const Mark& mark)
{
    act(mark, status_.commanded, 0, [&] {
        radius_ = gantry_.touch_off() / units_.mm() * units_.mm();
        tell(gantry_.status());
    });
    return radius_;
}

void Recorder::change_wheel(const Mark& mark)
{
    act(mark, status_.commanded, 0, [&] {
        gantry_.change_wheel();
        tell(gantry_.status());
    });
}

void Recorder::decide(const Mark& mark)
{
    if (!live_ && !resumes()) return go_over(mark, 0);
    TraceRow row = row_of(status_, radius_, 0);
    row.layer = mark.layer, row.pass = mark.pass, row.event = mark.event;
    record(row);
}

template <class Work>
const GantryStatus& Recorder::act(const Mark& mark, const Eigen::Vector3d& target, double feed, const Work& work)
{
    if (resumes()) go_live();
    if (!live_) {
        go_over(mark, feed);
        return status_;
    }
    if (journal_ != nullptr)
        journal_->begin({.time = status_.time,
                         .tool = target,
                         .layer = mark.layer,
                         .pass = mark.pass,
                         .event = Event::begun,
                         .feed = feed});
    work();
    TraceRow row = row_of(status_, radius_, feed);
    row.layer = mark.layer, row.pass = mark.pass, row.event = mark.event;
    record(row);
    return status_;
}

void Recorder::go_over(const Mark& mark, double feed)
{
    const TraceRow& row = done_[next_++];
    if (row.layer != mark.layer || row.pass != mark.pass || row.event != mark.event || (row.feed > 0) != (feed > 0))
        throw InputError(source_, "point " + std::to_string(next_) +
                                      " is not what this plan and these options do: it is of another run");
    status_ = status_of(row);
    radius_ = row.radius;
    trace_.push_back(row);
}

void Recorder::tell(const GantryStatus& status)
{
    const double mm = units_.mm(), newton = units_.newton();
    const double tip = held_place(status.commanded.z() + status.deflection, mm);
    status_.time = status.time + later_;
    status_.deflection = held(status.deflection, mm);
    status_.commanded << held_place(status.commanded.x(), mm), held_place(status.commanded.y(), mm),
        tip - status_.deflection;
    status_.force = held(status.force, newton);
    status_.peak_force = held(status.peak_force, newton);
}

void Recorder::record(TraceRow row)
{
    if (journal_ != nullptr) journal_->done(row);
    trace_.push_back(row);
}

} // namespace fettle
