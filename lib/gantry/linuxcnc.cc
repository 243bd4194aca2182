#include "gantry/linuxcnc.h"

#include "gantry/linuxcnc_words.h"

#include <algorithm>
#include <numbers>
#include <thread>

namespace fettle::gantry {
namespace {

/// Period of the servo thread.
constexpr std::chrono::milliseconds kPollPeriod{1};
/// Descent to the work: at 20 mm/s a slow axis of 1000 mm/s² stops within 0.2 mm.
constexpr double kDescentSpeed = 20;        // mm/s
constexpr double kBlendTolerance = 0.01;    // of a blended corner (G64 P), mm
constexpr double kPositionTolerance = 1e-4; // mm
constexpr double kContactShare = 0.1;       // of the desired deflection, that counts as a contact

} // namespace

LinuxcncGantry::LinuxcncGantry(const std::string& ini, const job::Job& job)
    : link_(ini), job_(job), new_radius_(job.wheel.radius), measured_radius_(job.wheel.radius)
{
    acceleration_ = std::min({link_.setting("AXIS_X", "MAX_ACCELERATION"), link_.setting("AXIS_Y", "MAX_ACCELERATION"),
                              link_.setting("AXIS_Z", "MAX_ACCELERATION")});
    latency_ = link_.setting("FETTLE", "LATENCY");
    touch_deflection_ = link_.setting("FETTLE", "TOUCH");
    plate_ << link_.setting("FETTLE", "PLATE_X"), link_.setting("FETTLE", "PLATE_Y"),
        link_.setting("FETTLE", "PLATE_Z");
    link_.set_max_force(job.force.max);
    link_.enable();
    update_status();
    raise_to(job_.safe_height);
    turn_to(job.theta);
}

void LinuxcncGantry::turn_to(double theta)
{
    finish_motion();
    raise_to(job_.safe_height);
    run("G0" + word("C", theta * 180 / std::numbers::pi));
}

protocol::Limits LinuxcncGantry::limits() const
{
    Eigen::Vector3d min, max;
    for (int k = 0; k < 3; ++k) {
        const std::string axis = std::string("AXIS_") + "XYZ"[k];
        min[k] = link_.setting(axis, "MIN_LIMIT");
        max[k] = link_.setting(axis, "MAX_LIMIT");
    }
    return {min, max, link_.setting("TRAJ", "MAX_LINEAR_VELOCITY"), link_.setting("FETTLE", "MAX_FORCE")};
}

GantryStatus LinuxcncGantry::travel(const Eigen::Vector3d& tool_point)
{
    finish_motion();
    travel_over(tool_point.head<2>(), job_.safe_height);
    lower_to(tool_point.z());
    return status_;
}

GantryStatus LinuxcncGantry::travel_low(const Eigen::Vector3d& tool_point, double over, double free)
{
    finish_motion();
    travel_over(tool_point.head<2>(), over);
    const double down = std::max(free, tool_point.z());
    if (down < status_.commanded.z()) run("G0" + word("Z", down - wheel_wear()));
    lower_to(tool_point.z());
    return status_;
}

GantryStatus LinuxcncGantry::lift(double commanded_z)
{
    finish_motion();
    update_status();
    if (commanded_z > status_.commanded.z())
        raise_to(commanded_z);
    else
        lower_to(commanded_z);
    return status_;
}

GantryStatus LinuxcncGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    if (pressing_) finish_motion();
    const Eigen::Vector3d end = tool_point - wheel_wear() * Eigen::Vector3d::UnitZ();
    step_to(end, word("X", end.x()) + word("Y", end.y()) + word("Z", end.z()), feed);
    return status_;
}

GantryStatus LinuxcncGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    const double deflection = (force - job_.force.preload) / job_.force.stiffness;
    if (!(deflection > 0)) throw GantryFault("the head's spring is preloaded with more than that force");
    const double lowest = tool_point.z() - wheel_wear();
    if (!pressing_) {
        finish_motion();
        raise_to(job_.safe_height);
        pressing_ = true;
        approach_part(deflection, lowest);
    }
    link_.set_press(true, deflection, lowest);
    step_to({tool_point.x(), tool_point.y(), 0}, word("X", tool_point.x()) + word("Y", tool_point.y()), feed);
    return status_;
}

/// Descends in place under force control until the wheel is on the part.
void LinuxcncGantry::approach_part(double deflection, double lowest)
{
    link_.set_press(true, deflection, lowest);
    link_.set_hold(true);
    do {
        wait_a_period();
        link_.done(); // for faults
    } while (status_.deflection < kContactShare * deflection && link_.drives().z() > lowest + kPositionTolerance);
}

/// Sends a step, and waits until the next one is due.
void LinuxcncGantry::step_to(const Eigen::Vector3d& end, const std::string& words, double feed)
{
    status_.peak_force = 0;
    update_status();
    if (path_.empty()) path_.push_back(path_position());
    link_.set_hold(true);
    const std::string corners = blending_ ? "" : "G64" + word("P", kBlendTolerance) + " ";
    blending_ = true;
    link_.send_gcode(corners + "G1" + words + feed_word(feed));
    path_.push_back(end);
    // With blended corners LinuxCNC brakes at half of the acceleration.
    const double ahead = feed * feed / acceleration_ + feed * latency_;
    for (bool done = false; !done && remaining_path_length() > ahead;) {
        wait_a_period();
        if (link_.held() && !pressing_) { // under force control Z yields, and the motion continues
            const double force = status_.peak_force;
            link_.abort();
            path_.clear();
            update_status();
            status_.force = std::max(status_.force, force); // the force that has stopped it, not what is left of it
            break;
        }
        done = link_.done();
        if (done) path_.clear();
    }
}

void LinuxcncGantry::change_wheel()
{
    finish_motion();
    raise_to(job_.safe_height);
    const int other = 3 - wheel_;
    run("T" + std::to_string(other) + " M6");
    wheel_ = other;
    measured_radius_ = new_radius_;
    raise_to(job_.safe_height);
}

void LinuxcncGantry::travel_over(const Eigen::Vector2d& xy, double height)
{
    raise_to(std::max(height, status_.commanded.z()));
    run("G0" + word("X", xy.x()) + word("Y", xy.y()));
}

void LinuxcncGantry::raise_to(double z)
{
    link_.set_hold(false); // or it could not leave a force above F_max
    const double at = link_.drives().z();
    if (z - wheel_wear() > at + kPositionTolerance) run("G0" + word("Z", z - wheel_wear()));
}

/// Descends until z or F_max is reached.
void LinuxcncGantry::lower_to(double z)
{
    update_status();
    const double end = z - wheel_wear();
    if (link_.drives().z() - end < kPositionTolerance) return;
    link_.set_hold(true);
    link_.send_gcode("G61 G1" + word("Z", end) + feed_word(kDescentSpeed));
    blending_ = false;
    while (!link_.done()) {
        wait_a_period();
        if (!link_.held()) continue;
        link_.abort();
        break;
    }
    update_status();
}

/// Executes a line of G-code to its end.
void LinuxcncGantry::run(const std::string& line)
{
    link_.send_gcode(line);
    while (!link_.done()) {
        wait_a_period();
    }
    update_status();
}

/// Waits for the end of the path, which is cut short if the force exceeds F_max, and resets the peak force.
void LinuxcncGantry::finish_motion()
{
    while (!path_.empty() && !link_.done()) {
        wait_a_period();
        if (link_.held() && !pressing_) link_.abort();
    }
    path_.clear();
    if (pressing_) end_press();
    update_status();
    status_.peak_force = 0;
}

/// Ends the force control: Z returns to its commanded position, the safe height.
void LinuxcncGantry::end_press()
{
    link_.set_press(false);
    while (link_.drives().z() < job_.safe_height - wheel_wear() - kPositionTolerance) {
        std::this_thread::sleep_for(kPollPeriod);
        link_.done(); // for faults
    }
    pressing_ = false;
}

/// Waits while the machine moves. @throws Interrupted
void LinuxcncGantry::wait_a_period()
{
    std::this_thread::sleep_for(kPollPeriod);
    update_status();
    if (is_interrupted()) end_motion();
}

/// Brakes for the operator.
void LinuxcncGantry::end_motion()
{
    link_.abort();
    link_.set_touch(false);
    path_.clear();
    if (pressing_) end_press(); // Z goes up by itself
    update_status();
    throw Interrupted();
}

void LinuxcncGantry::update_status()
{
    status_.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    status_.commanded = link_.drives() + wheel_wear() * Eigen::Vector3d::UnitZ();
    status_.deflection = link_.deflection();
    status_.force = link_.force();
    status_.peak_force = std::max(status_.peak_force, status_.force);
}

/// Position of the drives as a point of path_.
Eigen::Vector3d LinuxcncGantry::path_position() const
{
    Eigen::Vector3d at = link_.drives();
    if (pressing_) at.z() = 0;
    return at;
}

/// Drops the corners of the path that have been passed. @return  mm
double LinuxcncGantry::remaining_path_length()
{
    const Eigen::Vector3d at = path_position();
    while (path_.size() > 2) {
        const Eigen::Vector3d along = path_[1] - path_[0];
        if ((at - path_[0]).dot(along) < along.squaredNorm() - 2 * kBlendTolerance * along.norm()) break;
        path_.pop_front();
    }
    if (path_.size() < 2) return 0;
    double length = (path_[1] - at).norm();
    for (std::size_t i = 2; i < path_.size(); ++i) length += (path_[i] - path_[i - 1]).norm();
    return length;
}

} // namespace fettle::gantry
