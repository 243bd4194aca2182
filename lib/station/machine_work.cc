#include "station/machine_work.h"

#include "core/error.h"

#include <algorithm>
#include <limits>
#include <thread>

namespace fettle::station {
namespace {

constexpr std::chrono::milliseconds kShowPeriod{100};
constexpr std::chrono::milliseconds kMaxDelay{50};  // of a simulated machine against its pace
constexpr std::chrono::milliseconds kWaitPeriod{2}; // between two looks at the operator while a machine is waited for

} // namespace

MachineWork::MachineWork(const StationOptions& options, const Folder& folder, Session& session, Workplace& place,
                         strategy::SteeringClock& clock)
    : options_(options), folder_(folder), session_(session), place_(place), clock_(clock)
{
}

void MachineWork::prepare()
{
    const Record& record = session_.record();
    if (record.stage != Stage::anomaly && record.stage != Stage::sampling && record.stage != Stage::touch) {
        plan_ = plan::read_plan(folder_.file(kPlanFile));
        place_.open_to_grind(record.job, traces());
    } else {
        place_.open_to_touch(record.job);
    }
    live_.machine = gantry().status();
    live_.has_machine = true;
}

strategy::Teacher& MachineWork::teacher()
{
    gantry::OpenGantry& machine = place_.open_to_touch(session_.record().job);
    arm(false);
    if (!teacher_)
        teacher_.emplace(session_.record().job, *machine.gantry, machine.limits,
                         options_.lowest.value_or(machine.limits.min.z()));
    return *teacher_;
}

void MachineWork::move(const Eigen::Vector2d& direction)
{
    strategy::Teacher& shown = teacher();
    shown.move(direction, clock_.advance(strategy::kTeachingPeriod));
    live_.machine = gantry().status();
    keep_pace(live_.machine.time);
}

Eigen::Vector3d MachineWork::touch_here()
{
    const Eigen::Vector3d touch = teacher().touch();
    live_.machine = gantry().status();
    return touch;
}

void MachineWork::turn_to(double theta)
{
    job::Job turned = session_.record().job;
    teacher_.reset();
    place_.open_to_touch(turned);
    const Eigen::Vector2d at = gantry().status().commanded.head<2>();
    turned.theta = theta;
    gantry::OpenGantry& machine = place_.open_to_touch(turned);
    session_.turn(theta);
    // A simulated machine was made anew, and stands over the middle of the part.
    machine.gantry->travel({at.x(), at.y(), std::max(turned.safe_height, machine.gantry->status().commanded.z())});
    live_.machine = machine.gantry->status();
}

void MachineWork::touch_and_plan(const Save& save)
{
    teacher_.reset();
    plan_.reset();
    place_.require_safe_height(session_.record().job);
    place_.open_to_touch(session_.record().job);
    arm(true);
    add_warnings(
        touch_surface(session_.record(), gantry(), folder_, options_.planning, [&](const Eigen::Vector3d& touch) {
            session_.add_touch(touch);
            save();
            is_stopped(gantry().status());
        }));
    std::vector<std::string> doubts;
    plan_ = plan_job(session_.record().job, folder_, options_.planning, doubts);
    add_warnings(doubts);
    session_.planned();
    if (!doubts.empty()) session_.refuse(doubts.front());
    clock_.steering.discard();
}

void MachineWork::arm(bool follows)
{
    follows_ = follows;
    steering_begin_ = clock_.time;
    machine_begin_ = paced_time_ = gantry().status().time;
    gantry().set_interrupt([this](const gantry::GantryStatus& now) { return is_stopped(now); });
}

/// Asked by the machine between its moves, and in them.
bool MachineWork::is_stopped(const gantry::GantryStatus& now)
{
    live_.machine = now;
    if (follows_) clock_.time = std::max(clock_.time, steering_begin_ + now.time - machine_begin_);
    keep_pace(now.time);
    show(false);
    asked_ = now.time;
    return is_terminated() || clock_.steering.stop_due(clock_.time);
}

/// Lets a simulated machine take as long as a real one, in which the operator may stop it.
void MachineWork::keep_pace(double machine_time)
{
    if (!(options_.pace > 0) || !place_.is_simulated()) return;
    const std::chrono::duration<double> more((machine_time - paced_time_) / options_.pace);
    paced_time_ = machine_time;
    // Real time goes on while the operator thinks; what the computer is behind by a little is made up for.
    paced_until_ = std::max(paced_until_, Clock::now() - kMaxDelay) + std::chrono::duration_cast<Clock::duration>(more);
    while (Clock::now() < paced_until_ && !is_terminated() && !clock_.steering.stop_due(clock_.time)) {
        std::this_thread::sleep_for(kWaitPeriod);
        show(false);
    }
}

void MachineWork::show(bool now)
{
    if (!options_.show || (!now && Clock::now() < next_show_)) return;
    next_show_ = Clock::now() + kShowPeriod;
    options_.show(draw_screen(session_, plan_ ? &*plan_ : nullptr, live_));
}

void MachineWork::retract()
{
    gantry::retract(gantry(), session_.record().job.safe_height);
    gantry().lift(std::max(session_.record().job.safe_height, gantry().status().commanded.z()));
    live_.machine = gantry().status();
    teacher_.reset();
    clock_.steering.discard();
}

void MachineWork::give_up(const std::string& failure)
{
    failure_ = failure;
    teacher_.reset();
    place_.close();
}

void MachineWork::leave()
{
    teacher_.reset();
    place_.close();
}

void MachineWork::add_warnings(const std::vector<std::string>& more)
{
    for (const std::string& warning : more)
        if (std::ranges::find(warnings_, warning) == warnings_.end()) warnings_.push_back(warning);
}

} // namespace fettle::station
