#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"

#include <vector>

namespace fettle {

/// What the job does not say about the machine. The speeds are those of a laboratory gantry with ball screws.
struct QuasiStaticOptions {
    double rapid = 100;             ///< travelling, mm/s
    double lift_speed = 50;         ///< the Z drive alone, up and down, mm/s
    double touch_off_time = 10;     ///< to P0 beside the work and back, two slow touches, s
    double wheel_change_time = 120; ///< by hand, s
    /// A touch at P0 tells the radius to one count of the Z drive's encoder, mm.
    double touch_off_resolution = 0.005;
    /// Volume of stock ground off per volume of wheel (G ratio). Common wheels reach 20 to 80 on steel and iron.
    double grinding_ratio = 60;
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

/// A simulated gantry whose head is in equilibrium at every moment: drives follow their commands exactly, the spring
/// carries the wheel (press() in removal/preston.h), the stock is a height field. For studies; no inertia, no damping.
///
/// The drives know the radius of the last touch-off. As the wheel wears its rim stands higher than they believe, by
/// what it has lost since: material is left, never ground too deep.
class QuasiStaticGantry final : public Gantry {
  public:
    /// Stands at the safe height over the middle of the stock, with a new wheel.
    /// @throws InputError for options that are not positive
    QuasiStaticGantry(HeightField stock, const Job& job, const QuasiStaticOptions& options = {});
    QuasiStaticGantry(const QuasiStaticGantry&) = delete;
    QuasiStaticGantry& operator=(const QuasiStaticGantry&) = delete;

    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    /// @throws InputError for a feed that is not positive, or if the wheel is worn away
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    GantryStatus status() const override { return status_; }

    const HeightField& stock() const { return stock_; }
    const GrindTotals& totals() const { return totals_; }
    double true_radius() const { return radius_; } ///< what the drives do not know, mm

  private:
    void begin_move();
    std::vector<double> sub_steps(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;
    void raise_to(double z);
    void lower_to(double z);
    void go_to_safe_height();
    void press_for(const Eigen::Vector3d& commanded, double duration);
    void wear(double removed_volume);
    void spend(double duration, double& account);
    double loss() const { return known_radius_ - radius_; } ///< the rim's height over the drives' belief

    HeightField stock_;
    WheelInStock wheel_;
    Spring spring_;
    QuasiStaticOptions options_;
    Eigen::Matrix2d R_working_machine_;
    double removal_;      ///< c, mm³/(N s)
    double new_radius_;   ///< of a new wheel, mm
    double width_;        ///< mm
    double safe_height_;  ///< z, mm
    double most_force_;   ///< F_max, guards the way down, N
    double radius_;       ///< now, mm
    double known_radius_; ///< at the last touch-off, mm
    double pending_ = 0;  ///< time since the last sub-step that the next one has to grind for, s
    double bending_ = 0;  ///< change of the deflection in the last sub-step, mm
    GantryStatus status_;
    GrindTotals totals_;
};

} // namespace fettle
