#pragma once

#include "core/constants.h"
#include "machining/cutter_path.h"

#include <Eigen/Core>

#include <iosfwd>
#include <string>

namespace fettle::machining {

/// Writes moves as blocks of G-code: absolute coordinates (G90), arcs in the XY plane (G17). Modal words and
/// coordinates that do not change are left out. Five decimals in mm, seven in inches: finer than any drive.
class NcWriter {
  public:
    explicit NcWriter(std::ostream& out) : out_(out) {}

    /// Writes a straight move. Coordinates that are NaN are left out.
    /// @param tip  mm   @param feed  mm/s; 0: rapid
    void move_to(const Eigen::Vector3d& tip, double feed);
    /// Writes a move along its line or arc.
    void move_to(const CutterMove& move);
    /// Sets the unit of the following blocks: inches (G20) or mm (G21).
    void set_inches(bool inches);
    /// Makes the next move write its G word.
    void reset_motion_mode() { motion_.clear(); }

  private:
    void block(const std::string& motion, const Eigen::Vector3d& tip, double feed, const std::string& centre);
    std::string number(double mm) const;

    std::ostream& out_;
    std::string motion_;
    Eigen::Vector3d at_ = Eigen::Vector3d::Constant(core::kNaN); ///< last position, mm; NaN: not known
    double feed_ = 0;                                            ///< last feed, mm/s; 0: not known
    bool inches_ = false;
};

} // namespace fettle::machining
