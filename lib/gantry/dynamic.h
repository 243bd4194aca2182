#pragma once

#include "gantry/force_loop.h"
#include "gantry/machine.h"
#include "gantry/servo.h"
#include "gantry/virtual_gantry.h"

#include <cstdint>
#include <optional>
#include <random>

namespace fettle {

struct DynamicOptions : VirtualOptions {
    std::uint64_t seed = 1; ///< of the transducer's noise
};

/// A simulated gantry that moves (Wang 2007, 6.1.2): three servo drives, the head's spring and damper, and the stock.
///
/// Between contacts everything is linear, and exact (servo.h). A contact is where wheel and stock are balanced anew:
/// when the wheel has gone a sub-step, or for a while pressed on one place. From one to the next the wheel goes on as
/// it did. The head has no mass of its own (Wang 2007, 6.1.2: neglected).
///
/// Removal goes by the force normal to the rim. On slopes it has a part in the wheel's plane, and so has the tangential
/// force: they bend head and machine back, and load the drives, as the side force does while the wheel moves along
/// its axis. The spindle loses speed while grinding takes more than its power, and stalls.
///
/// Commands accelerate as the slowest axis can. A step of grind() ends when the command passes its end; where the next
/// one goes another way, the corner is round. What the strategy learns comes from the encoders and the transducer:
/// below the spring's preload there is no force to be seen.
class DynamicGantry final : public VirtualGantry {
  public:
    /// Stands at the safe height over the middle of the stock, with a new wheel, and has turned the head to θ.
    /// @throws InputError if no controller holds a drive's margins, or the work lies outside the machine's range
    DynamicGantry(HeightField stock, const Job& job, const Machine& machine, const DynamicOptions& options = {});

    /// All four: @throws GantryFault, InputError for a place outside the machine's range
    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    protocol::Limits limits() const override;

    const ServoAxis& axis(int k) const { return axes_[static_cast<std::size_t>(k)]; }
    const Eigen::Vector2d& side_load() const { return push_; } ///< of the stock on X and Y, N

  private:
    void turn_head(double theta);
    void check_range(const Eigen::Vector3d& tool_point) const;
    Eigen::Vector3d along_line(const Eigen::Vector3d& off, const Eigen::Vector3d& along, double feed) const;
    void come_down(double lowest, double wanted);
    double hold(double lowest, double wanted);
    void halt();
    void run_to(const Eigen::Vector3d& target, double speed, bool guarded);
    double touching_speed(double force) const;
    void down_to(double z);
    void go_to_safe_height() override;
    void move_reference(const Eigen::Vector3d& velocity);
    void tick();
    void check_following() const;
    void measure();

    bool contact_due() const;
    void meet();
    Balance press_at(double recoil, double dt, double preload, double stiffness, double stop);
    double find_recoil(double dt, double preload, double stiffness, double stop, Balance& balance);
    void load_drives(const Balance& balance, double dt);
    void drive_spindle(double normal_force, double dt);
    Eigen::Vector3d actual() const;
    double nut() const { return axes_[2].motion().p; }

    Machine machine_;
    std::array<ServoAxis, 3> axes_;
    double acceleration_; ///< of commands, mm/s²
    Pid force_gains_;
    std::optional<ForceLoop> force_loop_; ///< while it presses
    std::mt19937_64 random_;

    struct {
        Eigen::Vector3d p, v = Eigen::Vector3d::Zero(), a = Eigen::Vector3d::Zero();
    } reference_;
    Eigen::Vector3d line_end_; ///< of the last step: the next one's line begins there

    double tip_ = 0;             ///< z_r, where the wheel is, as the drives believe, mm
    double tip_rate_ = 0;        ///< until the next contact
    double deflection_ = 0;      ///< at the last contact
    double stop_force_ = 0;      ///< vertical, while the head stands on its stop
    double recoil_ = 0;          ///< of the wheel along Y_w
    double held_impulse_ = 0;    ///< on a row of a wall that still stands, N s
    Eigen::Vector2d push_{0, 0}; ///< on X and Y, N
    Eigen::Vector3d met_at_;     ///< the last contact
    int since_ = 0;              ///< periods since then
    double spindle_energy_ = 0;
    double* account_ = nullptr; ///< of the time that goes by
};

} // namespace fettle
