#pragma once

#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"
#include "sampling/order.h"
#include "json/document.h"

#include <optional>

namespace fettle::gantry {

/// Settings that neither the job nor a machine file has.
struct VirtualOptions {
    double touch_off_time = 10;     ///< to P0 beside the work and back, two slow touches, s
    double wheel_change_time = 120; ///< by hand, s
    /// Resolution of a measured height, or of the radius at P0: one count of the Z drive's encoder, mm.
    double touch_resolution = 0.005;
    sampling::ProbingMachine
        probing; ///< its speeds; it searches for the surface at `approach`, from the safe height on
    std::optional<double> grinding_ratio; ///< overrides the job's
    /// The stock's removal coefficient relative to the job's.
    double removal_factor = 1;
    /// Length of a simulation step in cells. Between two steps the rim leaves a ridge of step² / 8R: 0.0002 mm for
    /// 0.2 mm and R = 25.4 mm.
    double substep = 2;
};

/// Volume of stock ground off per volume of wheel (G ratio) where the job's wheel has none: from the middle of what
/// common wheels have on steel and iron, 20 to 80.
inline constexpr double kUsualGrindingRatio = 60;

/// Totals of a run. mm³, s, mm.
struct GrindTotals {
    double removed_volume = 0;
    double grinding_time = 0; ///< in grind()
    double travel_time = 0;   ///< in travel() and lift()
    double service_time = 0;  ///< touch-offs and wheel changes
    double grinding_length = 0;
    int touch_offs = 0;
    int wheel_changes = 0;
};

/// Adds the times to a report.
void add_report(json::Value& report, const GrindTotals& totals);

/// Base of the simulated gantries on a simulated stock. The wheel is a disc in a height field, it wears, and the
/// simulated time is counted.
///
/// The drives use the radius of the last touch-off. As the wheel wears, its rim is higher than they assume, by the wear
/// since then: material is left, never ground too deep.
class VirtualGantry : public Gantry {
  public:
    VirtualGantry(const VirtualGantry&) = delete;
    VirtualGantry& operator=(const VirtualGantry&) = delete;

    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    /// The cells of the stock lie along the wheel's axis. @throws GantryFault for another θ
    void turn_to(double theta) override;
    GantryStatus status() const override { return status_; }

    virtual protocol::Limits limits() const = 0;
    const removal::HeightField& stock() const { return stock_; }
    const GrindTotals& totals() const { return totals_; }
    double true_radius() const { return radius_; } ///< unknown to the drives, mm

  protected:
    /// The member of GrindTotals that a time belongs to.
    enum class TimeBucket { grinding, travel, service };

    /// Starts at the safe height over the middle of the stock, with a new wheel.
    /// @throws InputError for options that are not positive
    VirtualGantry(removal::HeightField stock, const job::Job& job, const VirtualOptions& options,
                  const removal::RimForce& rim);

    virtual void go_to_safe_height() = 0;
    /// @throws Interrupted
    void begin_move()
    {
        check_interrupt();
        status_.peak_force = status_.force;
    }
    /// Wears the wheel by the grinding ratio. @throws InputError if nothing is left of it
    void wear(double removed_volume);
    void advance_time(double duration, TimeBucket bucket);
    /// Work that takes time in one place: a touch, a change of the wheel. @throws Interrupted within kStopPeriod
    void serve(double duration);
    double round_to_resolution(double length) const;                 ///< of a touch
    double wheel_wear() const { return measured_radius_ - radius_; } ///< since the last touch-off, mm

    removal::HeightField stock_;
    removal::WheelInStock wheel_;
    removal::Spring spring_;
    VirtualOptions options_;
    Eigen::Matrix2d R_working_machine_;
    double removal_;         ///< c, mm³/(N s)
    double grinding_ratio_;  ///< volume of stock per volume of wheel
    double new_radius_;      ///< of a new wheel, mm
    double width_;           ///< mm
    double safe_height_;     ///< z, mm
    double tip_radius_;      ///< of the probe, mm
    double max_force_;       ///< F_max, at which a guarded descent stops, N
    double radius_;          ///< of the worn wheel, mm
    double measured_radius_; ///< at the last touch-off, mm
    GantryStatus status_;
    GrindTotals totals_;
};

/// @throws InputError unless it is positive
void check_positive(double value, const char* name);

} // namespace fettle::gantry
