// Simulation of a period of the dynamic gantry: drives, contact of wheel and stock, sensors.

#include "gantry/dynamic.h"

#include "core/text.h"
#include "geometry/uniform_draws.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::gantry {
namespace {

/// Longest time between two contact updates: the stock recedes under a wheel that is pressed on one place.
constexpr double kMaxContactInterval = 0.01; // s
/// Tolerance of the wheel's position along Y_w; at a wall the force halves over less than a cell.
constexpr double kRecoilToleranceCells = 0.1;
/// A steeper climb was a wall: the wheel does not keep this velocity.
constexpr double kMaxSlope = 1;
/// Share of its full energy below which the spindle has stalled: half of its speed.
constexpr double kMinEnergyShare = 0.25;

} // namespace

void DynamicGantry::simulate_period()
{
    const double period = machine_.period;
    const auto reference = [&](int k) { return Reference{reference_.p[k], reference_.v[k], reference_.a[k]}; };
    for (const int k : {0, 1}) axes_[k].step(reference(k), side_load_[k]);
    if (deflection_ > 0) {
        axes_[2].step_with_spring(reference(2), spring_.preload, tip_, tip_rate_);
        tip_ += tip_rate_ * period;
    } else {
        axes_[2].step(reference(2), stop_force_);
        tip_ = nut_z();
    }
    advance_time(period, time_bucket_);
    ++periods_since_contact_;
    check_following_error();
    if (contact_update_due()) update_contact();
    measure();
}

void DynamicGantry::check_following_error() const
{
    for (int k = 0; k < 3; ++k) {
        const double lag = std::abs(reference_.p[k] - axes_[k].measured());
        if (lag > machine_.axes[k].following_error)
            throw GantryFault(std::string("following error of axis ") + "xyz"[k] + ": " + core::to_short_text(lag) +
                              " mm at " + core::to_short_text(status_.time) + " s; the drive is switched off");
    }
}

/// The transducer measures the spring, not the force at the stop.
void DynamicGantry::measure()
{
    double deflection = std::max(tip_ - nut_z(), 0.0);
    if (machine_.head.noise > 0) deflection += geometry::draw_normal(random_, machine_.head.noise);
    deflection = std::max(std::round(deflection / machine_.head.lvdt) * machine_.head.lvdt, 0.0);
    status_.deflection = deflection;
    status_.force = deflection > 0 ? spring_.force(deflection) : 0;
    status_.peak_force = std::max(status_.peak_force, status_.force);
    for (int k = 0; k < 3; ++k) status_.commanded[k] = axes_[k].measured();
}

Eigen::Vector3d DynamicGantry::position() const
{
    return {axes_[0].motion().p, axes_[1].motion().p, axes_[2].motion().p};
}

bool DynamicGantry::contact_update_due() const
{
    const Eigen::Vector3d motion = position() - contact_position_;
    const double step = options_.substep * stock_.cell;
    return motion.squaredNorm() >= step * step || periods_since_contact_ * machine_.period >= kMaxContactInterval ||
           (deflection_ > 0 && tip_ < nut_z());
}

/// Finds the balance of wheel and stock after the time since the last update. The damper's force is that of the mean
/// speed in this time: with it the spring has the stiffness K + b / dt, and b · deflection / dt less preload.
void DynamicGantry::update_contact()
{
    const double dt = periods_since_contact_ * machine_.period, damper = machine_.head.damping / dt;
    const double stiffness = spring_.stiffness + damper;
    const double preload = spring_.preload - damper * deflection_;
    // Deflection of the head without contact.
    const double free = std::max(-preload / stiffness, 0.0);
    const double stop = nut_z() + free + wheel_wear();

    removal::Balance balance;
    recoil_ = find_recoil(dt, std::max(preload, 0.0), stiffness, stop, balance);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    wear(balance.volume);

    const double before = tip_ - tip_rate_ * dt, deflection = balance.z_tip - wheel_wear() - nut_z();
    const double climbed = nut_z() + deflection - before;
    const bool slope = std::abs(climbed) <= kMaxSlope * (position() - contact_position_).norm();
    tip_rate_ = deflection > 0 && deflection_ > 0 && slope ? climbed / dt : 0;
    tip_ = nut_z() + deflection;
    deflection_ = deflection;
    stop_force_ = balance.force;
    load_drives(balance, dt);
    contact_position_ = position();
    periods_since_contact_ = 0;
    if (deflection > machine_.head.travel)
        throw GantryFault("the head's travel of " + core::to_short_text(machine_.head.travel) + " mm is exceeded at " +
                          core::to_short_text(status_.time) + " s");
}

removal::Balance DynamicGantry::press_at(double recoil, double dt, double preload, double stiffness, double stop)
{
    const Eigen::Vector2d xy = R_working_machine_ * position().head<2>() + Eigen::Vector2d(0, recoil);
    wheel_.place(xy, radius_, stop);
    return fettle::removal::press(wheel_, {preload, stiffness}, stop, removal_ * dt, tip_ + wheel_wear());
}

/// Finds the recoil u at which the elastic force of the machine balances the contact force along Y_w: push(u) = k u.
/// Moving the wheel towards the wall that pushes it increases the push, so r(u) = push(u) / k − u falls by at least 1
/// per unit, and the root lies between u and u + r(u): regula falsi (Illinois).
///
/// A row of cells at an upright wall can only be removed as a whole, so r may jump over its root there. The wheel is
/// then held until the impulse k u dt equals the impulse that removes the row.
double DynamicGantry::find_recoil(double dt, double preload, double stiffness, double stop, removal::Balance& balance)
{
    const double tolerance = kRecoilToleranceCells * stock_.cell, k = machine_.head.stiffness;
    struct Side {
        double u, r, push;
    };
    const auto evaluate = [&](double u) {
        balance = press_at(u, dt, preload, stiffness, stop);
        return Side{u, balance.push / k - u, std::abs(balance.push)};
    };
    Side a = evaluate(recoil_);
    if (std::abs(a.r) <= tolerance) return a.u;
    Side b = evaluate(a.u + a.r);
    while (std::abs(b.r) > tolerance && std::abs(b.u - a.u) > tolerance) {
        const Side c = evaluate((a.u * b.r - b.u * a.r) / (b.r - a.r));
        if ((c.r > 0) == (b.r > 0))
            a.r /= 2;
        else
            a = b;
        b = c;
    }
    if (std::abs(b.r) <= tolerance) return b.u;
    const auto [out, in] = a.push < b.push ? std::pair(a, b) : std::pair(b, a);
    held_impulse_ += (k * std::abs(b.u) - out.push) * dt;
    const double row_impulse = (in.push - out.push) * dt;
    const bool row_removed = held_impulse_ >= row_impulse;
    if (row_removed) held_impulse_ -= row_impulse;
    evaluate(row_removed ? in.u : out.u);
    balance.push = k * b.u;
    return b.u;
}

void DynamicGantry::load_drives(const removal::Balance& balance, double dt)
{
    const double normal = balance.volume / (removal_ * dt); // Preston, summed over the contact
    const Eigen::Vector3d motion = position() - contact_position_;
    const double distance = motion.head<2>().norm();
    const double sideways = distance > 0 ? (R_working_machine_ * motion.head<2>()).x() / distance : 0;
    side_load_ =
        R_working_machine_.transpose() * Eigen::Vector2d(-machine_.spindle.side * normal * sideways, balance.push);
    drive_spindle(normal, dt);
}

/// Grinding power beyond the spindle's power is taken from its kinetic energy. The removal does not depend on its
/// speed.
void DynamicGantry::drive_spindle(double normal_force, double dt)
{
    const Spindle& spindle = machine_.spindle;
    const double full = spindle.inertia * spindle.speed * spindle.speed / 2;
    const double speed = spindle.speed * std::sqrt(spindle_energy_ / full);
    const double taken = spindle.tangential * normal_force * radius_ * speed;
    spindle_energy_ = std::min(spindle_energy_ + (spindle.power - taken) * dt, full);
    if (spindle_energy_ < kMinEnergyShare * full)
        throw GantryFault("the spindle stalls: " + core::to_short_text(normal_force) + " N take " +
                          core::to_short_text(taken / 1000) + " W of " + core::to_short_text(spindle.power / 1000) +
                          " W at " + core::to_short_text(status_.time) + " s");
}

} // namespace fettle::gantry
