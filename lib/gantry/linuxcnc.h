#pragma once

#include "gantry/gantry.h"
#include "gantry/linuxcnc_link.h"
#include "gantry/protocol.h"
#include "job/job.h"

#include <chrono>
#include <deque>

namespace fettle {

/// A gantry behind LinuxCNC, as samples/machines/linuxcnc sets it up.
///
/// The machine's Z stands for the tool point of a new wheel; a smaller one's is higher, by what touch_off() has found.
/// LinuxCNC slows down where it does not know how it goes on: grind() returns while there is still a way to go, as long
/// as the machine needs to stop and the next step to come. Everything else ends at rest.
class LinuxcncGantry final : public Gantry {
  public:
    /// Switches the machine on, homes it, and turns the head to θ at the safe height.
    /// @throws InputError for a setting that is missing, GantryFault if LinuxCNC does not answer
    LinuxcncGantry(const std::string& ini, const Job& job);

    protocol::Limits limits() const;
    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    /// From the safe height, and back to it before anything else is done.
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    GantryStatus status() const override { return status_; }

  private:
    void look();
    void run(const std::string& line);
    void settle();
    void come_down(double wanted, double lowest);
    void let_go();
    void step_to(const Eigen::Vector3d& end, const std::string& words, double feed);
    void down_to(double z);
    void rise_to(double z);
    void go_over(const Eigen::Vector2d& xy);
    double touch_down(double lowest);
    Eigen::Vector3d place() const;
    double way_to_go();
    double worn() const { return new_radius_ - known_radius_; }

    LinuxcncLink link_;
    Job job_;
    double new_radius_, known_radius_; ///< mm
    double acceleration_;              ///< of the slowest axis, mm/s²
    double latency_;                   ///< of a step of the strategy, until it is planned, s
    double touch_at_;                  ///< deflection at which the probe trips, mm
    Eigen::Vector3d plate_;            ///< P0
    int wheel_ = 1;                    ///< its number in the tool table: 1 or 2
    bool blending_ = true;             ///< does the machine go through the corners?
    bool pressing_ = false;            ///< Z goes as the force asks, and the way is over X and Y
    std::deque<Eigen::Vector3d> way_;  ///< that is still to go, from its beginning; machine's coordinates
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    GantryStatus status_;
};

} // namespace fettle
