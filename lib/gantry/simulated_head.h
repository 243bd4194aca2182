#pragma once

#include "job/job.h"
#include "removal/preston.h"

#include <iosfwd>
#include <string>

namespace fettle::gantry {

/// Head and stock of a simulation that runs in a machine controller's own clock.
struct HeadAndStock {
    removal::HeightField stock;
    removal::Spring spring;
    double removal = 0;        ///< c, mm³/(N s)
    double radius = 0;         ///< of a new wheel, mm
    double width = 0;          ///< of the wheel, mm
    double tip_radius = 0;     ///< of the probe, mm
    double grinding_ratio = 0; ///< volume of stock per volume of wheel, as in job::GrindingWheel
};

HeadAndStock head_and_stock(removal::HeightField stock, const job::Job& job);

/// Writes a binary file in the byte order of this machine.
void write_head(std::ostream& out, const HeadAndStock& head);
/// @throws InputError if it is not such a file, or cut short
HeadAndStock read_head(const std::string& path);

/// Wang's plate P0, on which the wheel is measured: a disc that faces up.
struct Plate {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0; ///< 0: there is none
};

/// The head in equilibrium, as on the quasi-static gantry, but driven by a controller: each period it gets the position
/// of the drives, and returns the reading of the spring's transducer.
class SimulatedHead {
  public:
    explicit SimulatedHead(HeadAndStock head);
    SimulatedHead(const SimulatedHead&) = delete;
    SimulatedHead& operator=(const SimulatedHead&) = delete;

    enum class Tool { wheel, probe };
    /// Simulates one period of the controller.
    /// @param drives  tool point of a new wheel, or of the probe; M, mm
    void step(const Eigen::Vector3d& drives, double period, Tool tool, const Plate& plate);
    void renew_wheel() { radius_ = head_.radius; }

    double deflection() const { return deflection_; } ///< mm
    double force() const { return force_; }           ///< N
    double radius() const { return radius_; }         ///< of the worn wheel, mm
    const HeadAndStock& head() const { return head_; }

  private:
    bool contact_update_due(const Eigen::Vector2d& xy, double z) const;
    void rest_on(double surface, double z_stop);

    HeadAndStock head_;
    removal::WheelInStock wheel_;
    Eigen::Matrix2d R_working_machine_;
    double radius_;
    double deflection_ = 0, force_ = 0;
    double pending_time_ = 0;    ///< since the last contact update, s
    Eigen::Vector2d contact_xy_; ///< of that update, W
    double contact_z_ = 0;       ///< of the drives
};

} // namespace fettle::gantry
