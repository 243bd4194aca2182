#include "station/session.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "strategy/teach.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::station {
namespace {

using strategy::Button;

constexpr std::size_t kMinCorners = 3; // of a boundary

} // namespace

Session::Session(Record record) : record_(std::move(record))
{
    if (record_.stage != Stage::grind && record_.stage != Stage::manual) return;
    record_.stage = Stage::stopped;
    message_ = "the program ended while the machine was at work";
}

Command Session::input(const strategy::Stick& stick)
{
    if (stick.end) return Command::end;
    if (stick.button != Button::none) message_.clear();
    if (stick.button == Button::stop) message_ = "the machine stands";
    if (record_.stage == Stage::anomaly || record_.stage == Stage::sampling) return teach(stick);
    return choose(stick.button);
}

Command Session::teach(const strategy::Stick& stick)
{
    switch (stick.button) {
    case Button::record:
        return Command::record;
    case Button::turn_left:
        return Command::turn_left;
    case Button::turn_right:
        return Command::turn_right;
    case Button::back:
        take_back();
        return Command::none;
    case Button::next:
        complete_boundary();
        return Command::none;
    default:
        return stick.direction.norm() > 0 ? Command::move : Command::none;
    }
}

/// The modes can be changed wherever the machine may grind next.
Command Session::choose(Button button)
{
    const bool may_grind = record_.stage != Stage::touch;
    switch (button) {
    case Button::automatic:
        if (may_grind && record_.stage != Stage::done) record_.mode = Mode::automatic;
        return Command::none;
    case Button::manual:
        if (may_grind) record_.mode = Mode::manual;
        return Command::none;
    case Button::back:
        if (record_.stage == Stage::touch) record_.stage = Stage::sampling;
        if (record_.stage == Stage::review) {
            record_.stage = Stage::touch;
            record_.touches.clear();
        }
        return Command::none;
    case Button::start:
        return start();
    default:
        return Command::none;
    }
}

Command Session::start()
{
    if (record_.stage == Stage::touch) return Command::touch;
    if (record_.mode == Mode::manual) return Command::steer;
    return record_.stage == Stage::done ? Command::none : Command::grind;
}

/// Without a point that can be taken back, the boundary before is at hand again.
void Session::take_back()
{
    if (!points().empty())
        points().pop_back();
    else
        record_.stage = Stage::anomaly;
}

void Session::complete_boundary()
{
    const bool is_taught = !points().empty();
    if (is_taught && points().size() < kMinCorners) {
        message_ = "a boundary needs at least three points";
    } else if (record_.stage == Stage::anomaly) {
        record_.stage = Stage::sampling;
    } else {
        complete_job();
    }
}

/// Boundaries that were not shown are those of the settings; but a new anomaly does not keep the old area around it.
void Session::complete_job()
{
    try {
        job::Job job = record_.settings;
        job.theta = record_.job.theta;
        const auto taught = strategy::boundaries_of_touches(job, record_.anomaly, record_.sampling);
        if (!record_.anomaly.empty()) job.anomaly = taught.anomaly;
        if (!record_.sampling.empty())
            job.sampling = taught.sampling;
        else if (!record_.anomaly.empty())
            job.sampling.resize(3, 0);
        record_.job = job::validated(job, "the boundaries");
        record_.stage = Stage::touch;
        record_.touches.clear();
    } catch (const core::InputError& error) {
        message_ = error.what();
    }
}

void Session::add_point(const Eigen::Vector3d& point)
{
    const job::Job& job = record_.job;
    const double mm = job.units.mm();
    const std::string at = job::point_text(point.head<2>(), job.units);
    if (point.z() >= job.safe_height) {
        message_ = "safe_height " + core::to_short_text(job.safe_height / mm) + " is not above the touch at z " +
                   core::to_short_text(point.z() / mm);
        return;
    }
    points().push_back(point);
    message_ = std::isnan(point.z()) ? at + ": no surface there; the point has no z"
                                     : at + ", z " + core::to_short_text(point.z() / mm);
}

void Session::turn(double theta) { record_.job.theta = theta; }

void Session::add_touch(const Eigen::Vector3d& touch) { record_.touches.push_back(touch); }

void Session::planned()
{
    record_.stage = Stage::review;
    record_.mode = Mode::automatic;
}

void Session::begin(Stage work)
{
    record_.stage = work;
    message_.clear();
    if (work == Stage::manual) ++record_.manual_runs;
}

void Session::ground(const strategy::GrindRun& run)
{
    record_.stage = run.finished ? Stage::done : Stage::stopped;
    record_.peak_force = std::max(record_.peak_force, run.force.peak);
    message_ = run.finished ? "all is within tolerance" : run.failure;
}

void Session::steered(const strategy::ManualRun& run)
{
    record_.stage = Stage::stopped;
    record_.peak_force = std::max(record_.peak_force, run.peak_force);
    message_ = run.failure;
}

} // namespace fettle::station
