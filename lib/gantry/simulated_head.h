#pragma once

#include "job/job.h"
#include "removal/preston.h"

#include <iosfwd>
#include <string>

namespace fettle {

/// What a simulated head carries and stands over, beside a machine controller's own clock.
struct HeadAndStock {
    HeightField stock;
    Spring spring;
    double removal = 0;     ///< c, mm³/(N s)
    double radius = 0;      ///< of a new wheel, mm
    double width = 0;       ///< of the wheel, mm
    double tip_radius = 0;  ///< of the probe, mm
    double grind_ratio = 0; ///< volume of stock per volume of wheel; as VirtualOptions has it
};

HeadAndStock head_and_stock(HeightField stock, const Job& job);

/// A working file, of the machine that wrote it.
void write_head(std::ostream& out, const HeadAndStock& head);
/// @throws InputError if it is none, or cut short
HeadAndStock read_head(const std::string& path);

/// Wang's plate P0, on which the wheel is measured: a disc that faces up.
struct Plate {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0; ///< 0: there is none
};

/// The head in equilibrium, as on the quasi-static gantry, but led by a controller: it is told where the drives stand,
/// period after period, and says what the transducer of its spring sees.
class SimulatedHead {
  public:
    explicit SimulatedHead(HeadAndStock head);
    SimulatedHead(const SimulatedHead&) = delete;
    SimulatedHead& operator=(const SimulatedHead&) = delete;

    enum class Tool { wheel, probe };
    /// One period of the controller. @param drives  the tool point of a new wheel, or of the probe; M, mm
    void step(const Eigen::Vector3d& drives, double period, Tool tool, const Plate& plate);
    void renew_wheel() { radius_ = head_.radius; }

    double deflection() const { return deflection_; } ///< mm
    double force() const { return force_; }           ///< N
    double radius() const { return radius_; }         ///< of the wheel, now
    const HeadAndStock& head() const { return head_; }

  private:
    bool due(const Eigen::Vector2d& xy, double z) const;
    void rest_on(double surface, double z_stop);

    HeadAndStock head_;
    WheelInStock wheel_;
    Eigen::Matrix2d R_working_machine_;
    double radius_;
    double deflection_ = 0, force_ = 0;
    double pending_ = 0;     ///< time since the last contact was met, s
    Eigen::Vector2d met_at_; ///< W
    double met_z_ = 0;       ///< of the drives
};

} // namespace fettle
