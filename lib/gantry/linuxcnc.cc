#include "gantry/linuxcnc.h"

#include "core/fixed_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

namespace fettle {
namespace {

// Between two looks: the servo thread's period.
constexpr std::chrono::milliseconds kLook{1};
// Down to the work: at 20 mm/s a slow axis of 1000 mm/s² stops within 0.2 mm.
constexpr double kDown = 20; // mm/s
// In search of the surface; and the touch that counts: 0.0005 mm in a period of the servo thread.
constexpr double kSearch = 10, kTouch = 0.5; // mm/s
// Back from the first touch; and over P0, whose height is known but for the wheel's wear.
constexpr double kBack = 0.5, kOverPlate = 3; // mm
constexpr double kCorner = 0.01;              // what a blended corner may cut off, mm
constexpr double kHere = 1e-4;                // mm: no way to go
constexpr double kFelt = 0.1;                 // of the deflection to be held: it is on the part

std::string word(const char* name, double value) { return std::string(" ") + name + to_fixed_text(value, 5); }

std::string feed_word(double mm_per_s) { return word("F", 60 * mm_per_s); }

} // namespace

LinuxcncGantry::LinuxcncGantry(const std::string& ini, const Job& job)
    : link_(ini), job_(job), new_radius_(job.wheel.radius), known_radius_(job.wheel.radius)
{
    acceleration_ = std::min({link_.setting("AXIS_X", "MAX_ACCELERATION"), link_.setting("AXIS_Y", "MAX_ACCELERATION"),
                              link_.setting("AXIS_Z", "MAX_ACCELERATION")});
    latency_ = link_.setting("FETTLE", "LATENCY");
    touch_at_ = link_.setting("FETTLE", "TOUCH");
    plate_ << link_.setting("FETTLE", "PLATE_X"), link_.setting("FETTLE", "PLATE_Y"),
        link_.setting("FETTLE", "PLATE_Z");
    link_.set_most_force(job.force.max);
    link_.enable();
    look();
    rise_to(job_.safe_height);
    run("G0" + word("C", job.theta * 180 / std::numbers::pi));
    look();
}

protocol::Limits LinuxcncGantry::limits() const
{
    protocol::Limits limits;
    for (int k = 0; k < 3; ++k) {
        const std::string axis = std::string("AXIS_") + "XYZ"[k];
        limits.least[k] = link_.setting(axis, "MIN_LIMIT");
        limits.most[k] = link_.setting(axis, "MAX_LIMIT");
    }
    limits.speed = link_.setting("TRAJ", "MAX_LINEAR_VELOCITY");
    limits.force = link_.setting("FETTLE", "MOST_FORCE");
    return limits;
}

GantryStatus LinuxcncGantry::travel(const Eigen::Vector3d& tool_point)
{
    settle();
    status_.peak_force = 0;
    go_over(tool_point.head<2>());
    down_to(tool_point.z());
    return status_;
}

GantryStatus LinuxcncGantry::lift(double commanded_z)
{
    settle();
    status_.peak_force = 0;
    look();
    if (commanded_z > status_.commanded.z())
        rise_to(commanded_z);
    else
        down_to(commanded_z);
    return status_;
}

GantryStatus LinuxcncGantry::grind(const Eigen::Vector3d& tool_point, double feed)
{
    if (pressing_) settle();
    const Eigen::Vector3d end = tool_point - worn() * Eigen::Vector3d::UnitZ();
    step_to(end, word("X", end.x()) + word("Y", end.y()) + word("Z", end.z()), feed);
    return status_;
}

GantryStatus LinuxcncGantry::press(const Eigen::Vector3d& tool_point, double feed, double force)
{
    const double wanted = (force - job_.force.preload) / job_.force.stiffness;
    if (!(wanted > 0)) throw GantryFault("the head's spring is preloaded with more than that force");
    const double lowest = tool_point.z() - worn();
    if (!pressing_) {
        settle();
        rise_to(job_.safe_height);
        pressing_ = true;
        come_down(wanted, lowest);
    }
    link_.set_press(true, wanted, lowest);
    step_to({tool_point.x(), tool_point.y(), 0}, word("X", tool_point.x()) + word("Y", tool_point.y()), feed);
    return status_;
}

/// In place, until the part is felt.
void LinuxcncGantry::come_down(double wanted, double lowest)
{
    link_.set_press(true, wanted, lowest);
    link_.set_hold(true);
    do {
        std::this_thread::sleep_for(kLook);
        look();
        link_.done(); // for faults
    } while (status_.deflection < kFelt * wanted && link_.drives().z() > lowest + kHere);
}

/// Streams a step, and follows the machine until the next is due.
void LinuxcncGantry::step_to(const Eigen::Vector3d& end, const std::string& words, double feed)
{
    status_.peak_force = 0;
    look();
    if (way_.empty()) way_.push_back(place());
    link_.set_hold(true);
    const std::string corners = blending_ ? "" : "G64" + word("P", kCorner) + " ";
    blending_ = true;
    link_.say(corners + "G1" + words + feed_word(feed));
    way_.push_back(end);
    // With blended corners it slows down at half of the acceleration.
    const double ahead = feed * feed / acceleration_ + feed * latency_;
    for (bool done = false; !done && way_to_go() > ahead;) {
        std::this_thread::sleep_for(kLook);
        look();
        if (link_.held() && !pressing_) { // pressed, Z gives way, and then it goes on
            const double force = status_.peak_force;
            link_.abort();
            way_.clear();
            look();
            status_.force = std::max(status_.force, force); // what has stopped it, not what is left of it
            break;
        }
        done = link_.done();
        if (done) way_.clear();
    }
}

double LinuxcncGantry::touch_off()
{
    settle();
    status_.peak_force = 0;
    look();
    const Eigen::Vector2d place = status_.commanded.head<2>();
    go_over(plate_.head<2>());
    run("G0" + word("Z", plate_.z() + kOverPlate));
    const double z = touch_down(plate_.z() - new_radius_);
    if (std::isnan(z)) throw GantryFault("there is no calibration plate where it should be");
    known_radius_ = z + new_radius_ - plate_.z();
    go_over(place);
    return known_radius_;
}

void LinuxcncGantry::change_wheel()
{
    settle();
    status_.peak_force = 0;
    rise_to(job_.safe_height);
    wheel_ = 3 - wheel_;
    run("T" + std::to_string(wheel_) + " M6");
    known_radius_ = new_radius_;
    rise_to(job_.safe_height);
}

double LinuxcncGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    settle();
    status_.peak_force = 0;
    go_over(xy);
    link_.set_tip(true);
    const double z = touch_down(lowest);
    rise_to(job_.safe_height);
    link_.set_tip(false);
    look();
    return z;
}

/// Down in search of a contact, from where it stands; then again, slowly. @return  z of the machine; NaN: none
double LinuxcncGantry::touch_down(double lowest)
{
    link_.set_touch(true);
    run("G61 G38.3" + word("Z", lowest) + feed_word(kSearch));
    blending_ = false;
    double z = link_.touched();
    link_.set_touch(false);
    if (std::isnan(z)) return z;
    run("G0" + word("Z", z + kBack));
    link_.set_touch(true);
    run("G38.2" + word("Z", z - kBack) + feed_word(kTouch));
    z = link_.touched() + touch_at_;
    link_.set_touch(false);
    return z;
}

void LinuxcncGantry::go_over(const Eigen::Vector2d& xy)
{
    rise_to(std::max(job_.safe_height, status_.commanded.z()));
    run("G0" + word("X", xy.x()) + word("Y", xy.y()));
}

void LinuxcncGantry::rise_to(double z)
{
    link_.set_hold(false); // or it could not leave what is too much
    const double at = link_.drives().z();
    if (z - worn() > at + kHere) run("G0" + word("Z", z - worn()));
}

/// Until there, or F_max is reached.
void LinuxcncGantry::down_to(double z)
{
    look();
    const double end = z - worn();
    if (link_.drives().z() - end < kHere) return;
    link_.set_hold(true);
    link_.say("G61 G1" + word("Z", end) + feed_word(kDown));
    blending_ = false;
    while (!link_.done()) {
        std::this_thread::sleep_for(kLook);
        look();
        if (!link_.held()) continue;
        link_.abort();
        break;
    }
    look();
}

/// Until what was said is done.
void LinuxcncGantry::run(const std::string& line)
{
    link_.say(line);
    while (!link_.done()) {
        std::this_thread::sleep_for(kLook);
        look();
    }
    look();
}

/// The end of the way is ground; if that takes too much force, less of it.
void LinuxcncGantry::settle()
{
    while (!way_.empty() && !link_.done()) {
        std::this_thread::sleep_for(kLook);
        if (link_.held() && !pressing_) link_.abort();
    }
    way_.clear();
    if (pressing_) let_go();
    look();
}

/// Back up to where Z is commanded: the safe height.
void LinuxcncGantry::let_go()
{
    link_.set_press(false);
    while (link_.drives().z() < job_.safe_height - worn() - kHere) {
        std::this_thread::sleep_for(kLook);
        link_.done(); // for faults
    }
    pressing_ = false;
}

void LinuxcncGantry::look()
{
    status_.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    status_.commanded = link_.drives() + worn() * Eigen::Vector3d::UnitZ();
    status_.deflection = link_.deflection();
    status_.force = link_.force();
    status_.peak_force = std::max(status_.peak_force, status_.force);
}

/// On the way.
Eigen::Vector3d LinuxcncGantry::place() const
{
    Eigen::Vector3d at = link_.drives();
    if (pressing_) at.z() = 0;
    return at;
}

/// Drops what has been passed.
double LinuxcncGantry::way_to_go()
{
    const Eigen::Vector3d at = place();
    while (way_.size() > 2) {
        const Eigen::Vector3d along = way_[1] - way_[0];
        if ((at - way_[0]).dot(along) < along.squaredNorm() - 2 * kCorner * along.norm()) break;
        way_.pop_front();
    }
    if (way_.size() < 2) return 0;
    double length = (way_[1] - at).norm();
    for (std::size_t i = 2; i < way_.size(); ++i) length += (way_[i] - way_[i - 1]).norm();
    return length;
}

} // namespace fettle
