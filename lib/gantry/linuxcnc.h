#pragma once

#include "gantry/gantry.h"
#include "gantry/linuxcnc_link.h"
#include "gantry/protocol.h"
#include "job/job.h"

#include <chrono>
#include <deque>

namespace fettle::gantry {

/// A gantry behind LinuxCNC, as samples/machines/linuxcnc sets it up.
///
/// The machine's Z is the tool point of a new wheel; that of a smaller wheel is higher by the wear that touch_off() has
/// found. LinuxCNC slows down at the end of its program: grind() returns while some of the path is left, as much as the
/// machine needs to stop and the next step to arrive. Everything else ends at rest.
class LinuxcncGantry final : public Gantry {
  public:
    /// Switches the machine on, homes it, and turns the head to θ at the safe height.
    /// @throws InputError for a setting that is missing, GantryFault if LinuxCNC does not answer
    LinuxcncGantry(const std::string& ini, const job::Job& job);

    protocol::Limits limits() const;
    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    /// Starts from the safe height, and returns to it before any other motion.
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    void turn_to(double theta) override;
    GantryStatus status() const override { return status_; }

  private:
    void update_status();
    void wait_a_period();
    [[noreturn]] void end_motion();
    void run(const std::string& line);
    void finish_motion();
    void approach_part(double deflection, double lowest);
    void end_press();
    void step_to(const Eigen::Vector3d& end, const std::string& words, double feed);
    void lower_to(double z);
    void raise_to(double z);
    void travel_over(const Eigen::Vector2d& xy, double height);
    double touch_down(double lowest);
    Eigen::Vector3d path_position() const;
    double remaining_path_length();
    double wheel_wear() const { return new_radius_ - measured_radius_; }

    LinuxcncLink link_;
    job::Job job_;
    double new_radius_, measured_radius_; ///< mm
    double acceleration_;                 ///< of the slowest axis, mm/s²
    double latency_;                      ///< from a step of the strategy until it is planned, s
    double touch_deflection_;             ///< at which the probe trips, mm
    Eigen::Vector3d plate_;               ///< P0
    int wheel_ = 1;                       ///< its number in the tool table: 1 or 2
    bool blending_ = true;                ///< corners are blended (G64)
    bool pressing_ = false;               ///< Z follows the force, and the path is in X and Y
    std::deque<Eigen::Vector3d> path_;    ///< corners of the unfinished path, machine coordinates
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    GantryStatus status_;
};

} // namespace fettle::gantry
