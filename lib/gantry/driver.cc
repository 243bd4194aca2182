#include "gantry/driver.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle {
namespace {

/// A move's end may be off by what the corners of a machine are rounded by.
constexpr double kCorner = 5; // mm
/// Speed and clock of a machine are told to a few digits.
constexpr double kSpeedTold = 1.01;
constexpr double kInstant = 0.01; // s
/// A move may take so many times what its length and speed say.
constexpr double kSlow = 3;
/// Until it is there.
constexpr double kStartTime = 10; // s
/// Homing and a touch-off by the machine, a new wheel by hand.
constexpr double kServiceTime = 30, kWheelTime = 3600; // s
constexpr double kStopTime = 1;                        // s, for the answer to `stop`

std::string words(const Eigen::Vector3d& p) { return to_text(p.x()) + " " + to_text(p.y()) + " " + to_text(p.z()); }

} // namespace

DriverGantry::DriverGantry(const std::string& command, const Job& job, double patience)
    : command_(command), child_(command), patience_(patience), most_force_(job.force.max)
{
    connect(job);
}

DriverGantry::DriverGantry(const std::string& name, Descriptor socket, const Job& job, double patience)
    : command_(name), child_(std::move(socket)), patience_(patience), most_force_(job.force.max)
{
    connect(job);
}

void DriverGantry::connect(const Job& job)
{
    const std::string told = ask("connect " + protocol::kVersion, kStartTime);
    const std::string version = protocol::kVersion + " ";
    if (told.rfind(version, 0) != 0) fail("speaks something else than " + protocol::kVersion);
    try {
        limits_ = protocol::limits_in(std::string_view(told).substr(version.size()));
    } catch (const GantryFault& fault) {
        fail(fault.what());
    }
    if (!(limits_.speed > 0 && (limits_.least.array() < limits_.most.array()).all()))
        fail("has no range or no speed: '" + told + "'");
    if (job.force.max > limits_.force)
        throw InputError(job.source, "force.max is above the " + to_short_text(limits_.force) + " N of the machine");
    ask("limit " + to_text(job.force.max), 0);
    obey("home " + to_text(job.theta), kServiceTime);
}

DriverGantry::~DriverGantry()
{
    std::string line;
    if (failed_ || !child_.send(std::to_string(++asked_) + " quit")) return;
    child_.receive(patience_, line);
    child_.let_end(patience_); // it may have something to write
}

GantryStatus DriverGantry::travel(const Eigen::Vector3d& tool_point)
{
    const double way = (tool_point - status_.commanded).norm() + 2 * (limits_.most.z() - tool_point.z());
    return move("travel " + words(tool_point), tool_point, way / limits_.speed, true);
}

GantryStatus DriverGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    if (!(feed > 0 && feed <= limits_.speed))
        throw InputError("gantry", "a feed of " + to_text(feed) + " mm/s is not in the machine's range");
    const double way = (tool_point - status_.commanded).norm();
    return move("move " + words(tool_point) + " " + to_text(feed), tool_point, way / feed, false);
}

GantryStatus DriverGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    if (!(feed > 0 && feed <= limits_.speed))
        throw InputError("gantry", "a feed of " + to_text(feed) + " mm/s is not in the machine's range");
    const double way = (tool_point - status_.commanded).head<2>().norm();
    return move("press " + words(tool_point) + " " + to_text(feed) + " " + to_text(force), tool_point, way / feed,
                true);
}

GantryStatus DriverGantry::lift(double commanded_z)
{
    const Eigen::Vector3d target(status_.commanded.x(), status_.commanded.y(), commanded_z);
    return move("lift " + to_text(commanded_z), target, std::abs(commanded_z - status_.commanded.z()) / limits_.speed,
                true);
}

double DriverGantry::touch_off()
{
    const Eigen::Vector3d place = status_.commanded;
    const double radius = measure("touch_off", kServiceTime);
    back_over(place, "touch_off");
    if (!(radius > 0)) fail("measures a wheel of " + to_text(radius) + " mm");
    return radius;
}

double DriverGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    const Eigen::Vector3d end(xy.x(), xy.y(), lowest);
    check_range(end);
    const std::string command = "probe " + words(end);
    const double z = measure(command, kServiceTime + (end - status_.commanded).norm() / limits_.speed);
    back_over(end, command);
    if (z < lowest - kCorner || z > status_.commanded.z() + kCorner)
        fail("touches at z " + to_text(z) + " after '" + command + "'");
    return z;
}

void DriverGantry::change_wheel()
{
    const Eigen::Vector3d place = status_.commanded;
    obey("change_wheel", kWheelTime);
    back_over(place, "change_wheel");
}

/// Sends a command and waits for its answer, which is returned without number and "ok".
std::string DriverGantry::ask(const std::string& command, double duration)
{
    const std::string number = std::to_string(++asked_);
    const bool taken = child_.send(number + " " + command);
    const double time = patience_ + kSlow * duration;
    std::string line;
    switch (child_.receive(taken ? time : 0, line)) {
    case Child::Heard::silence:
        if (taken) fail("does not answer '" + command + "' within " + to_short_text(time) + " s");
        [[fallthrough]];
    case Child::Heard::end:
        fail(child_.ending());
    case Child::Heard::babble:
        fail("sends a line without an end");
    case Child::Heard::line:
        break;
    }
    std::string_view rest = line;
    const std::string_view answered = protocol::next_word(rest), verdict = protocol::next_word(rest);
    if (verdict == "error" && answered == number) fail("reports: " + std::string(rest));
    if (verdict != "ok") fail("makes no sense: '" + line.substr(0, 60) + "'");
    if (answered != number) fail("answers number " + std::string(answered) + " instead of " + number);
    return std::string(rest);
}

/// A command whose answer is a number, or "none" (NaN), and a status.
double DriverGantry::measure(const std::string& command, double duration)
{
    const std::string told = ask(command, duration);
    std::string_view rest = told;
    const std::string_view measured = protocol::next_word(rest);
    double number = std::numeric_limits<double>::quiet_NaN();
    try {
        if (measured != "none") number = protocol::number_in(measured);
        accept(protocol::status_in(rest));
    } catch (const GantryFault& fault) {
        fail(fault.what());
    }
    return number;
}

const GantryStatus& DriverGantry::obey(const std::string& command, double duration)
{
    const std::string told = ask(command, duration);
    try {
        accept(protocol::status_in(told));
    } catch (const GantryFault& fault) {
        fail(fault.what());
    }
    return status_;
}

const GantryStatus& DriverGantry::move(const std::string& command, const Eigen::Vector3d& target, double duration,
                                       bool guarded)
{
    check_range(target);
    obey(command, duration);
    if (status_.force >= most_force_) return status_; // the guard has stopped it, wherever that was
    const Eigen::Vector3d off = status_.commanded - target;
    const bool held = guarded && off.z() > 0; // the way down ended early
    if (off.head<2>().norm() > kCorner || (!held && std::abs(off.z()) > kCorner))
        fail("stands at " + words(status_.commanded) + " after '" + command + "'");
    return status_;
}

void DriverGantry::accept(const GantryStatus& status)
{
    if (status.force < 0 || status.deflection < 0 || status.peak_force < status.force)
        throw GantryFault("reports a force of " + to_text(status.force) + " N, at most " + to_text(status.peak_force) +
                          " N, at a deflection of " + to_text(status.deflection) + " mm");
    const double time = status.time - status_.time;
    const double way = (status.commanded - status_.commanded).norm();
    if (known_ && time < 0) throw GantryFault("goes back in time, to " + to_text(status.time) + " s");
    if (known_ && way > kSpeedTold * limits_.speed * (time + kInstant))
        throw GantryFault("jumps by " + to_short_text(way) + " mm in " + to_short_text(time) + " s");
    status_ = status;
    known_ = true;
}

/// The machine is where it was, but for the height.
void DriverGantry::back_over(const Eigen::Vector3d& place, const std::string& command)
{
    if ((status_.commanded - place).head<2>().norm() > kCorner)
        fail("stands at " + words(status_.commanded) + " after '" + command + "'");
}

void DriverGantry::check_range(const Eigen::Vector3d& target)
{
    if ((target.array() >= limits_.least.array()).all() && (target.array() <= limits_.most.array()).all()) return;
    throw InputError(command_, "the machine does not reach " + words(target) + " mm");
}

/// Stops the machine as well as the driver still can; the child's destructor ends the driver.
void DriverGantry::fail(const std::string& problem)
{
    failed_ = true;
    std::string line;
    if (child_.send(std::to_string(++asked_) + " stop")) child_.receive(kStopTime, line);
    throw GantryFault("driver '" + command_ + "' " + problem + "; stopped");
}

} // namespace fettle
