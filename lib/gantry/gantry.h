#pragma once

#include "core/error.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <utility>

namespace fettle::gantry {

/// The machine has stopped for good: a drive cannot follow, the spindle stalls, the driver has died. One line.
class GantryFault : public core::InputError {
  public:
    using core::InputError::InputError;
};

/// The operator has stopped the machine in a move, or before one. Nothing is wrong: it can be moved again.
class Interrupted : public std::exception {
  public:
    const char* what() const noexcept override { return "stopped by the operator"; }
};

/// State that the machine reports: positions in the machine frame M, mm, N, s.
struct GantryStatus {
    double time = 0;                                     ///< since the start, s
    Eigen::Vector3d commanded = Eigen::Vector3d::Zero(); ///< tool point at the drives' position
    double deflection = 0; ///< of the head's spring, upward: the tool point is `commanded` + deflection · Z
    double force = 0;      ///< along the spring, vertical, at the end of the move; 0 without contact
    double peak_force = 0; ///< the largest during the move
};

/// Asked during a move whether the machine has to stop. @param now  the last known state
using Interrupt = std::function<bool(const GantryStatus& now)>;

/// A machine that carries the wheel. The tool point is the lowest point of the wheel, at the middle of its width.
/// strategy/ uses this interface and knows no machine; a gantry knows no strategy. Every method that moves may throw
/// GantryFault, and Interrupted.
class Gantry {
  public:
    virtual ~Gantry() = default;

    /// Travels without grinding: up to the safe height, across, down to `tool_point`. The descent is guarded: the
    /// drives stop early (see `commanded`) where the force reaches the head's F_max.
    virtual GantryStatus travel(const Eigen::Vector3d& tool_point) = 0;
    /// Travels where the stock is known: up to z = `over` if it stands lower, across, down to z = `free`, and then
    /// guarded as travel() does. A machine that only knows travel() goes over the safe height.
    virtual GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free);
    /// Grinds in a straight line to `tool_point` at `feed`, mm/s. One step of the strategy: a few tenths of a mm to
    /// some mm.
    virtual GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) = 0;
    /// Grinds in a straight line to x, y of `tool_point` at `feed`, mm/s, under force control: the drives move up and
    /// down so that the force along the spring is `force`, N, but not below z of `tool_point`. Where nothing is under
    /// the wheel they descend in search of the part. A machine without force control throws GantryFault.
    virtual GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force);
    /// Lifts straight up, or lowers (guarded, as travel() does), in place, without feed.
    virtual GantryStatus lift(double commanded_z) = 0;
    /// Touches the calibration plate P0 and measures the wheel's radius, mm; returns above its position, to the safe
    /// height. Takes time.
    virtual double touch_off() = 0;
    /// Mounts a new wheel; returns above its position, to the safe height. Takes time.
    virtual void change_wheel() = 0;
    /// Touches the part with the probe, whose tip is at the tool point: up to the safe height, across, down in search
    /// of the surface, fast and then slowly, and back up to the safe height. Takes time.
    /// @param lowest  lower bound of the tip's z
    /// @return  z of the tip's lowest point at the touch; NaN if it found no surface
    virtual double probe(const Eigen::Vector2d& xy, double lowest) = 0;
    /// Turns the head at the safe height, so that the wheel's axis is at θ, rad. A machine that cannot throws
    /// GantryFault.
    virtual void turn_to(double theta);
    /// Tells a robot where the job lies, before anything moves: the pose of the job's frame in its cell, mm. A machine
    /// on which the part is laid in its own frame throws GantryFault, a robot also if it does not reach the job there.
    virtual void set_frame(const Eigen::Isometry3d& T_cell_job);
    virtual GantryStatus status() const = 0;
    /// Largest feed that grind() takes, mm/s.
    virtual double max_feed() const { return std::numeric_limits<double>::infinity(); }

    /// Lets the operator stop the machine: `interrupt` is asked before each move, and during it as often as the machine
    /// can. Where it returns true the move ends at once with Interrupted, and nothing is asked until this is called
    /// again: retract() can lift the wheel.
    void set_interrupt(Interrupt interrupt) { interrupt_ = std::move(interrupt); }

  protected:
    /// True once, if the operator stops the machine.
    bool is_interrupted()
    {
        if (!interrupt_ || !interrupt_(status())) return false;
        interrupt_ = nullptr;
        return true;
    }
    void check_interrupt()
    {
        if (is_interrupted()) throw Interrupted();
    }

  private:
    Interrupt interrupt_;
};

/// Lifts the wheel off the part after an interruption, no higher than the safe height: by the spring's deflection and a
/// clearance, so that it is off at once. @throws GantryFault
inline GantryStatus retract(Gantry& gantry, double safe_height)
{
    constexpr double kClearance = 2; // mm: more than the drives of a machine overshoot
    const GantryStatus now = gantry.status();
    const double free = now.commanded.z() + now.deflection + kClearance;
    return gantry.lift(std::max(std::min(free, safe_height), now.commanded.z()));
}

inline GantryStatus Gantry::travel_low(const Eigen::Vector3d& tool_point, double /*over*/, double /*free*/)
{
    return travel(tool_point);
}

inline GantryStatus Gantry::press(const Eigen::Vector3d& /*tool_point*/, double /*feed*/, double /*force*/)
{
    throw GantryFault("the machine cannot hold a force");
}

inline void Gantry::turn_to(double /*theta*/) { throw GantryFault("the machine cannot turn its head"); }

inline void Gantry::set_frame(const Eigen::Isometry3d& /*T_cell_job*/)
{
    throw GantryFault("the machine has a frame of its own, in which the part is to be laid");
}

} // namespace fettle::gantry
