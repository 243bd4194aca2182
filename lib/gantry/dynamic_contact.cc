// Wheel and stock of the dynamic gantry.

#include "gantry/dynamic.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle {
namespace {

/// Pressed on one place the stock recedes; so often the balance is found anew at least.
constexpr double kLongestWait = 0.01; // s
/// The wheel's place along Y_w is found to a tenth of a cell; at a wall the force halves over less than a cell.
constexpr double kRecoil = 0.1;
/// What is steeper is a wall: the wheel has climbed it, and does not go on so.
constexpr double kSteepest = 1;
/// A spindle below half of its speed has stalled.
constexpr double kStalledEnergy = 0.25;

} // namespace

Eigen::Vector3d DynamicGantry::actual() const
{
    return {axes_[0].motion().p, axes_[1].motion().p, axes_[2].motion().p};
}

bool DynamicGantry::contact_due() const
{
    const Eigen::Vector3d gone = actual() - met_at_;
    const double step = options_.substep * stock_.cell;
    return gone.squaredNorm() >= step * step || since_ * machine_.period >= kLongestWait ||
           (deflection_ > 0 && tip_ < nut());
}

/// The balance of wheel and stock after the time that has gone by. The damper's force is that of the mean speed since
/// the last contact: with it the spring is K + b / dt stiff, and preloaded less by b · deflection / dt.
void DynamicGantry::meet()
{
    const double dt = since_ * machine_.period, damper = machine_.head.damping / dt;
    const double stiffness = spring_.stiffness + damper;
    const double preload = spring_.preload - damper * deflection_;
    // Where the head would be by now if nothing were in its way.
    const double free = std::max(-preload / stiffness, 0.0);
    const double stop = nut() + free + loss();

    Balance balance;
    recoil_ = find_recoil(dt, std::max(preload, 0.0), stiffness, stop, balance);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    wear(balance.volume);

    const double before = tip_ - tip_rate_ * dt, deflection = balance.z_tip - loss() - nut();
    const double climbed = nut() + deflection - before;
    const bool slope = std::abs(climbed) <= kSteepest * (actual() - met_at_).norm();
    tip_rate_ = deflection > 0 && deflection_ > 0 && slope ? climbed / dt : 0;
    tip_ = nut() + deflection;
    deflection_ = deflection;
    stop_force_ = balance.force;
    load_drives(balance, dt);
    met_at_ = actual();
    since_ = 0;
    if (deflection > machine_.head.travel)
        throw GantryFault("the head's travel of " + to_short_text(machine_.head.travel) + " mm is used up at " +
                          to_short_text(status_.time) + " s");
}

Balance DynamicGantry::press_at(double recoil, double dt, double preload, double stiffness, double stop)
{
    const Eigen::Vector2d xy = R_working_machine_ * actual().head<2>() + Eigen::Vector2d(0, recoil);
    wheel_.place(xy, radius_, stop);
    return fettle::press(wheel_, {preload, stiffness}, stop, removal_ * dt, tip_ + loss());
}

/// Where the machine, bent by the force along Y_w, holds against it: push(u) = k u. Moving the wheel on against what
/// pushes it makes it push more, so r(u) = push(u) / k − u falls by at least 1 per unit, and the root lies between u
/// and u + r(u): regula falsi (Illinois).
///
/// A row of cells at an upright wall goes whole, so r may jump over its root there. The wheel is held then, until the
/// impulse k u dt makes up for what the row takes.
double DynamicGantry::find_recoil(double dt, double preload, double stiffness, double stop, Balance& balance)
{
    const double enough = kRecoil * stock_.cell, k = machine_.head.stiffness;
    struct Side {
        double u, r, push;
    };
    const auto look = [&](double u) {
        balance = press_at(u, dt, preload, stiffness, stop);
        return Side{u, balance.push / k - u, std::abs(balance.push)};
    };
    Side a = look(recoil_);
    if (std::abs(a.r) <= enough) return a.u;
    Side b = look(a.u + a.r);
    while (std::abs(b.r) > enough && std::abs(b.u - a.u) > enough) {
        const Side c = look((a.u * b.r - b.u * a.r) / (b.r - a.r));
        if ((c.r > 0) == (b.r > 0))
            a.r /= 2;
        else
            a = b;
        b = c;
    }
    if (std::abs(b.r) <= enough) return b.u;
    const auto [out, in] = a.push < b.push ? std::pair(a, b) : std::pair(b, a);
    held_impulse_ += (k * std::abs(b.u) - out.push) * dt;
    const double row = (in.push - out.push) * dt;
    const bool through = held_impulse_ >= row;
    if (through) held_impulse_ -= row;
    look(through ? in.u : out.u);
    balance.push = k * b.u;
    return b.u;
}

void DynamicGantry::load_drives(const Balance& balance, double dt)
{
    const double normal = balance.volume / (removal_ * dt); // Preston, summed over the contact
    const Eigen::Vector3d gone = actual() - met_at_;
    const double way = gone.head<2>().norm();
    const double sideways = way > 0 ? (R_working_machine_ * gone.head<2>()).x() / way : 0;
    push_ = R_working_machine_.transpose() * Eigen::Vector2d(-machine_.spindle.side * normal * sideways, balance.push);
    drive_spindle(normal, dt);
}

/// What grinding takes beyond the spindle's power comes out of its rotation. Removal does not depend on its speed.
void DynamicGantry::drive_spindle(double normal_force, double dt)
{
    const Spindle& spindle = machine_.spindle;
    const double full = spindle.inertia * spindle.speed * spindle.speed / 2;
    const double speed = spindle.speed * std::sqrt(spindle_energy_ / full);
    const double taken = spindle.tangential * normal_force * radius_ * speed;
    spindle_energy_ = std::min(spindle_energy_ + (spindle.power - taken) * dt, full);
    if (spindle_energy_ < kStalledEnergy * full)
        throw GantryFault("the spindle stalls: " + to_short_text(normal_force) + " N take " +
                          to_short_text(taken / 1000) + " W of " + to_short_text(spindle.power / 1000) + " W at " +
                          to_short_text(status_.time) + " s");
}

} // namespace fettle
