#pragma once

#include "gantry/force_loop.h"
#include "gantry/machine.h"
#include "gantry/servo.h"
#include "gantry/virtual_gantry.h"

#include <cstdint>
#include <optional>
#include <random>

namespace fettle::gantry {

struct DynamicOptions : VirtualOptions {
    std::uint64_t seed = 1; ///< of the transducer's noise
};

/// A simulated gantry with dynamics (Wang 2007, 6.1.2): three servo drives, the head's spring and damper, and the
/// stock.
///
/// Between two contact updates the model is linear and is solved exactly (servo.h). A contact update finds the balance
/// of wheel and stock anew: when the wheel has moved by a sub-step, or has been pressed on one place for a while. From
/// one update to the next the wheel keeps its velocity. The head has no mass of its own (Wang 2007, 6.1.2: neglected).
///
/// The removal follows the force normal to the rim. On slopes this force has a component in the wheel's plane, and so
/// has the tangential force: they bend head and machine back, and load the drives, as the side force does while the
/// wheel moves along its axis. The spindle loses speed while grinding takes more than its power, and stalls.
///
/// Commands accelerate as the slowest axis can. A step of grind() ends when the command passes its end; at a change of
/// direction the corner is rounded. The strategy sees the encoders and the transducer: below the spring's preload the
/// transducer shows no force.
class DynamicGantry final : public VirtualGantry {
  public:
    /// Starts at the safe height over the middle of the stock, with a new wheel, and turns the head to θ.
    /// @throws InputError if no controller reaches a drive's margins, or the work lies outside the machine's range
    DynamicGantry(removal::HeightField stock, const job::Job& job, const Machine& machine,
                  const DynamicOptions& options = {});

    /// All four: @throws GantryFault, InputError for a target outside the machine's range
    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    protocol::Limits limits() const override;

    const Eigen::Vector2d& side_load() const { return side_load_; } ///< force of the stock on X and Y, N

  private:
    void turn_head(double theta);
    void check_range(const Eigen::Vector3d& tool_point) const;
    GantryStatus follow_line(const Eigen::Vector3d& tool_point, double feed, std::optional<double> force);
    Eigen::Vector3d velocity_along_line(const Eigen::Vector3d& off, const Eigen::Vector3d& along, double feed) const;
    void approach_part(double lowest, double deflection);
    double force_control_speed(double lowest, double deflection);
    void stop();
    void move_to(const Eigen::Vector3d& target, double speed, bool guarded);
    double max_contact_speed(double force) const;
    void lower_to(double z);
    void go_to_safe_height() override;
    void raise_from_part(double z);
    void move_reference(const Eigen::Vector3d& velocity);
    void simulate_period();
    void check_following_error() const;
    void measure();

    bool contact_update_due() const;
    void update_contact();
    removal::Balance press_at(double recoil, double dt, double preload, double stiffness, double stop);
    double find_recoil(double dt, double preload, double stiffness, double stop, removal::Balance& balance);
    void load_drives(const removal::Balance& balance, double dt);
    void drive_spindle(double normal_force, double dt);
    Eigen::Vector3d position() const;
    double nut_z() const { return axes_[2].motion().p; }

    Machine machine_;
    std::array<ServoAxis, 3> axes_;
    double acceleration_; ///< of commands, mm/s²
    Pid force_gains_;
    std::optional<ForceLoop> force_loop_; ///< while the force is controlled
    std::mt19937_64 random_;

    struct {
        Eigen::Vector3d p, v = Eigen::Vector3d::Zero(), a = Eigen::Vector3d::Zero();
    } reference_;              ///< of the three servo loops
    Eigen::Vector3d line_end_; ///< end of the last step, where the next step's line begins

    double tip_ = 0;                              ///< z_r, position of the wheel for the measured radius, mm
    double tip_rate_ = 0;                         ///< until the next contact update, mm/s
    double deflection_ = 0;                       ///< at the last contact update, mm
    double stop_force_ = 0;                       ///< vertical, while the head is on its stop, N
    double recoil_ = 0;                           ///< of the wheel along Y_w, mm
    double held_impulse_ = 0;                     ///< on a row of a wall that is not removed yet, N s
    Eigen::Vector2d side_load_{0, 0};             ///< on X and Y, N
    Eigen::Vector3d contact_position_;            ///< at the last contact update
    int periods_since_contact_ = 0;               ///< since that update
    double spindle_energy_ = 0;                   ///< N mm
    TimeBucket time_bucket_ = TimeBucket::travel; ///< of the current move
};

} // namespace fettle::gantry
