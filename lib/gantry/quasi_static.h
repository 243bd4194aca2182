#pragma once

#include "gantry/virtual_gantry.h"

#include <vector>

namespace fettle::gantry {

/// The speeds are those of a laboratory gantry with ball screws.
struct QuasiStaticOptions : VirtualOptions {
    double rapid = 100;     ///< travelling, mm/s
    double lift_speed = 50; ///< the Z drive alone, up and down, mm/s
};

/// A simulated gantry whose head is in equilibrium at every moment: drives follow their commands exactly, the spring
/// carries the wheel (press() in removal/preston.h), the stock is a height field. For studies; it has no inertia and no
/// damping. The removal follows the vertical force.
class QuasiStaticGantry final : public VirtualGantry {
  public:
    /// Starts at the safe height over the middle of the stock, with a new wheel.
    /// @throws InputError for options that are not positive
    QuasiStaticGantry(removal::HeightField stock, const job::Job& job, const QuasiStaticOptions& options = {});

    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override;
    /// @throws InputError for a feed that is not positive, or if the wheel is worn away
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus lift(double commanded_z) override;
    /// The simulation has no limits; these are large numbers.
    protocol::Limits limits() const override;

  private:
    std::vector<double> sub_steps(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;
    void raise_to(double z);
    void lower_to(double z);
    void sub_step_towards(double z, double step);
    void go_to_safe_height() override;
    void press_for(const Eigen::Vector3d& commanded, double duration);

    double rapid_, lift_speed_;
    double pending_time_ = 0;      ///< since the last sub-step, to be ground by the next one, s
    double deflection_change_ = 0; ///< in the last sub-step, mm
};

} // namespace fettle::gantry
