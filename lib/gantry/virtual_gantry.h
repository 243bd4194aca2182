#pragma once

#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"
#include "sampling/order.h"

namespace fettle {

/// What neither the job nor a machine file says.
struct VirtualOptions {
    double touch_off_time = 10;     ///< to P0 beside the work and back, two slow touches, s
    double wheel_change_time = 120; ///< by hand, s
    /// A touch tells a height, or the radius at P0, to one count of the Z drive's encoder, mm.
    double touch_resolution = 0.005;
    ProbingMachine probing; ///< its speeds: in search of the surface `approach`, all the way from the safe height
    /// Volume of stock ground off per volume of wheel (G ratio). Common wheels reach 20 to 80 on steel and iron.
    double grinding_ratio = 60;
    /// The stock's removal coefficient over the one that the job states.
    double removal_factor = 1;
    /// Length of a simulation step in cells. Between two steps the rim leaves a ridge of step² / 8R: 0.0002 mm for
    /// 0.2 mm and R = 25.4 mm.
    double substep = 2;
};

/// The account of a run. mm³, s, mm.
struct GrindTotals {
    double removed_volume = 0;
    double grinding_time = 0; ///< in grind()
    double travel_time = 0;   ///< in travel() and lift()
    double service_time = 0;  ///< touch-offs and wheel changes
    double grinding_length = 0;
    int touch_offs = 0;
    int wheel_changes = 0;
};

/// A simulated gantry on a simulated stock: what all of them share. The wheel is a disc in a height field, it wears,
/// and time goes by.
///
/// The drives know the radius of the last touch-off. As the wheel wears its rim stands higher than they believe, by
/// what it has lost since: material is left, never ground too deep.
class VirtualGantry : public Gantry {
  public:
    VirtualGantry(const VirtualGantry&) = delete;
    VirtualGantry& operator=(const VirtualGantry&) = delete;

    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    GantryStatus status() const override { return status_; }

    virtual protocol::Limits limits() const = 0;
    const HeightField& stock() const { return stock_; }
    const GrindTotals& totals() const { return totals_; }
    double true_radius() const { return radius_; } ///< what the drives do not know, mm

  protected:
    /// Stands at the safe height over the middle of the stock, with a new wheel.
    /// @throws InputError for options that are not positive
    VirtualGantry(HeightField stock, const Job& job, const VirtualOptions& options, const RimForce& rim);

    virtual void go_to_safe_height() = 0;
    void begin_move() { status_.peak_force = status_.force; }
    /// The rim loses its share. @throws InputError if nothing is left of it
    void wear(double removed_volume);
    void spend(double duration, double& account);
    double counted(double length) const;                    ///< by the Z drive's encoder
    double loss() const { return known_radius_ - radius_; } ///< the rim's height over the drives' belief

    HeightField stock_;
    WheelInStock wheel_;
    Spring spring_;
    VirtualOptions options_;
    Eigen::Matrix2d R_working_machine_;
    double removal_;      ///< c, mm³/(N s)
    double new_radius_;   ///< of a new wheel, mm
    double width_;        ///< mm
    double safe_height_;  ///< z, mm
    double tip_radius_;   ///< of the probe, mm
    double most_force_;   ///< F_max, guards the way down, N
    double radius_;       ///< now, mm
    double known_radius_; ///< at the last touch-off, mm
    GantryStatus status_;
    GrindTotals totals_;
};

/// @throws InputError unless it is positive
void check_positive(double value, const char* name);

} // namespace fettle
