#include "gantry/driver.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle::gantry {
namespace {

/// Longest duration of a move relative to its length and speed.
constexpr double kMaxDurationFactor = 3;
// Limits in s: for the start of the driver; for homing and a touch-off; for a wheel change by hand; for a stop.
constexpr double kStartTime = 10, kServiceTime = 30, kWheelTime = 3600, kStopTime = 1;
/// The clock of a machine that simulates is not ours: what is not a step at a known feed may take as long as the
/// longest command does.
constexpr double kMaxSimulatedTime = kMaxDurationFactor * kWheelTime; // s
/// F_max comes back as it was sent, but for the digits of its text.
constexpr double kEchoTolerance = 1e-6; // relative

} // namespace

DriverGantry::DriverGantry(const std::string& command, const job::Job& job, double timeout,
                           const std::optional<Head>& head, const std::optional<Eigen::Isometry3d>& T_cell_job)
    : command_(command), child_(command), timeout_(timeout), head_(head_check(job, head)),
      height_tolerance_(job.tolerance), new_radius_(job.wheel.radius)
{
    connect(job, T_cell_job);
}

DriverGantry::DriverGantry(const std::string& name, core::FileDescriptor socket, const job::Job& job, double timeout)
    : command_(name), child_(std::move(socket)), timeout_(timeout), head_(head_check(job, std::nullopt)),
      height_tolerance_(job.tolerance), new_radius_(job.wheel.radius)
{
    connect(job, std::nullopt);
}

void DriverGantry::connect(const job::Job& job, const std::optional<Eigen::Isometry3d>& T_cell_job)
{
    const std::string answer = request("connect " + protocol::kVersion, kStartTime);
    const std::string version = protocol::kVersion + " ";
    if (answer.rfind(version, 0) != 0) fail("speaks another protocol than " + protocol::kVersion);
    parse_or_fail([&] { limits_ = protocol::parse_limits(std::string_view(answer).substr(version.size())); });
    if (!(limits_.speed > 0 && (limits_.min.array() < limits_.max.array()).all()))
        fail("has no range or no speed: '" + answer + "'");
    if (job.force.max > limits_.force)
        throw core::InputError(job.source,
                               "force.max is above the " + core::to_short_text(limits_.force) + " N of the machine");
    if (T_cell_job) send_frame(*T_cell_job);
    set_limit(job.force.max);
    turn_to(job.theta);
}

/// A driver that does not know the command answers by an error, as a robot that does not reach the job there.
void DriverGantry::send_frame(const Eigen::Isometry3d& T_cell_job)
{
    const Answer answer = exchange("frame " + protocol::to_words(T_cell_job), kStartTime);
    if (answer.is_error) fail("does not take the job's frame: " + answer.text);
    parse_or_fail([&] { accept(protocol::parse_status(answer.text)); });
}

void DriverGantry::turn_to(double theta) { execute("home " + core::to_text(theta), kServiceTime); }

/// The answer says the force at which the machine guards its moves from now on.
void DriverGantry::set_limit(double force)
{
    const std::string answer = request("limit " + core::to_text(force), 0);
    double guarded = 0;
    parse_or_fail([&] { guarded = protocol::parse_finite_number(answer); });
    if (std::abs(guarded - force) > kEchoTolerance * force)
        fail("guards its moves at " + core::to_short_text(guarded) + " N instead of " + core::to_short_text(force));
}

DriverGantry::~DriverGantry()
{
    std::string line;
    if (failed_ || !child_.send(std::to_string(++last_number_) + " quit")) return;
    child_.receive(timeout_, line);
    child_.terminate(timeout_); // it may have a file to write
}

GantryStatus DriverGantry::travel(const Eigen::Vector3d& tool_point)
{
    const double distance = (tool_point - status_.commanded).norm() + 2 * (limits_.max.z() - tool_point.z());
    return move("travel " + protocol::to_words(tool_point), tool_point, distance / limits_.speed, true);
}

/// A driver that answers its first `travel_low` by an error does not know the command.
GantryStatus DriverGantry::travel_low(const Eigen::Vector3d& tool_point, double over, double free)
{
    if (travels_low_ == Known::no) return travel(tool_point);
    check_range(tool_point);
    check_range({tool_point.x(), tool_point.y(), over});
    const std::string command =
        "travel_low " + protocol::to_words(tool_point) + " " + core::to_text(over) + " " + core::to_text(free);
    const double up = std::max(over, status_.commanded.z());
    const double distance =
        (tool_point - status_.commanded).head<2>().norm() + 2 * up - status_.commanded.z() - tool_point.z();
    const Answer answer = exchange(command, distance / limits_.speed);
    if (answer.is_error && travels_low_ == Known::not_yet) {
        travels_low_ = Known::no;
        return travel(tool_point);
    }
    travels_low_ = Known::yes;
    return end_move(answer, command, tool_point, true);
}

GantryStatus DriverGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    check_feed(feed);
    const double distance = (tool_point - status_.commanded).norm();
    return move("move " + protocol::to_words(tool_point) + " " + core::to_text(feed), tool_point, distance / feed,
                false);
}

GantryStatus DriverGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    check_feed(feed);
    const double distance = (tool_point - status_.commanded).head<2>().norm();
    return move("press " + protocol::to_words(tool_point) + " " + core::to_text(feed) + " " + core::to_text(force),
                tool_point, distance / feed, true);
}

GantryStatus DriverGantry::lift(double commanded_z)
{
    const Eigen::Vector3d target(status_.commanded.x(), status_.commanded.y(), commanded_z);
    return move("lift " + core::to_text(commanded_z), target,
                std::abs(commanded_z - status_.commanded.z()) / limits_.speed, true);
}

double DriverGantry::touch_off()
{
    const Eigen::Vector3d position = status_.commanded;
    const double radius = measure("touch_off", kServiceTime);
    check_position(position, "touch_off");
    check_radius(radius);
    return radius;
}

double DriverGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    const Eigen::Vector3d end(xy.x(), xy.y(), lowest);
    check_range(end);
    const std::string command = "probe " + protocol::to_words(end);
    const double z = measure(command, kServiceTime + (end - status_.commanded).norm() / limits_.speed);
    check_position(end, command);
    if (z < lowest - protocol::kPositionTolerance || z > status_.commanded.z() + protocol::kPositionTolerance)
        fail("touches at z " + core::to_text(z) + " after '" + command + "'");
    return z;
}

void DriverGantry::change_wheel()
{
    const Eigen::Vector3d position = status_.commanded;
    execute("change_wheel", kWheelTime);
    check_position(position, "change_wheel");
    last_radius_ = 0;
}

/// @return  the answer of a driver that has done it
std::string DriverGantry::request(const std::string& command, double duration)
{
    return text_of(exchange(command, duration));
}

std::string DriverGantry::text_of(const Answer& answer)
{
    if (answer.is_error) fail("reports: " + answer.text);
    return answer.text;
}

/// Sends a command and waits for its answer.
DriverGantry::Answer DriverGantry::exchange(const std::string& command, double duration)
{
    check_interrupt();
    const std::string number = std::to_string(++last_number_);
    const bool taken = child_.send(number + " " + command);
    const double time = timeout_ + kMaxDurationFactor * duration;
    max_duration_ = command.starts_with("move ") ? time : std::max(time, kMaxSimulatedTime);
    std::string line;
    switch (receive(taken ? time : 0, line)) {
    case ChildProcess::Received::timeout:
        if (taken) fail("does not answer '" + command + "' within " + core::to_short_text(time) + " s");
        [[fallthrough]];
    case ChildProcess::Received::closed:
        fail(child_.exit_description());
    case ChildProcess::Received::too_long:
        fail("sends a line without an end");
    case ChildProcess::Received::line:
        break;
    }
    std::string_view rest = line;
    const std::string_view answered = protocol::next_word(rest), verdict = protocol::next_word(rest);
    if (verdict == "error" && answered == number) return {true, std::string(rest)};
    if (verdict != "ok") fail("makes no sense: '" + line.substr(0, 60) + "'");
    if (answered != number) fail("answers number " + std::string(answered) + " instead of " + number);
    return {false, std::string(rest)};
}

/// Executes a command whose answer is a number, or "none" (NaN), and a status.
double DriverGantry::measure(const std::string& command, double duration)
{
    const std::string answer = request(command, duration);
    std::string_view rest = answer;
    const std::string_view measured = protocol::next_word(rest);
    double number = std::numeric_limits<double>::quiet_NaN();
    parse_or_fail([&] {
        if (measured != "none") number = protocol::parse_finite_number(measured);
        accept(protocol::parse_status(rest));
    });
    return number;
}

/// Executes a command whose answer is a status.
void DriverGantry::execute(const std::string& command, double duration)
{
    const std::string answer = request(command, duration);
    parse_or_fail([&] { accept(protocol::parse_status(answer)); });
}

/// A malformed or implausible answer is the driver's fault.
template <class Parse>
void DriverGantry::parse_or_fail(const Parse& parse)
{
    try {
        parse();
    } catch (const GantryFault& fault) {
        fail(fault.what());
    }
}

const GantryStatus& DriverGantry::move(const std::string& command, const Eigen::Vector3d& target, double duration,
                                       bool guarded)
{
    check_range(target);
    return end_move(exchange(command, duration), command, target, guarded);
}

/// Takes in the answer to a move.
const GantryStatus& DriverGantry::end_move(const Answer& answer, const std::string& command,
                                           const Eigen::Vector3d& target, bool guarded)
{
    const std::string status = text_of(answer);
    parse_or_fail([&] { accept(protocol::parse_status(status)); });
    if (status_.force >= head_.max_force) return status_; // the guard has stopped the move early
    const Eigen::Vector3d off = status_.commanded - target;
    const bool held = guarded && off.z() > 0; // the descent ended early
    if (off.head<2>().norm() > protocol::kPositionTolerance ||
        (!held && std::abs(off.z()) > protocol::kPositionTolerance))
        fail("stands at " + protocol::to_words(status_.commanded) + " after '" + command + "'");
    if (held && !command.starts_with("press ")) check_contact(target, command);
    return status_;
}

/// Asks the driver to stop the machine; the destructor of child_ terminates the driver.
void DriverGantry::fail(const std::string& problem)
{
    failed_ = true;
    std::string line;
    if (child_.send(std::to_string(++last_number_) + " stop")) child_.receive(kStopTime, line);
    throw GantryFault("driver '" + command_ + "' " + problem + "; stopped");
}

} // namespace fettle::gantry
