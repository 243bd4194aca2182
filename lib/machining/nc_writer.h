#pragma once

#include "machining/cutter_path.h"

#include <Eigen/Core>

#include <iosfwd>
#include <limits>
#include <string>

namespace fettle {

/// Writes moves as blocks of G-code: places absolute (G90), arcs in the level (G17); words that still hold are left
/// out. Five decimals, finer than any drive, in inches seven.
class NcWriter {
  public:
    explicit NcWriter(std::ostream& out) : out_(out) {}

    /// Goes straight. Coordinates that are NaN are not said.
    /// @param feed  mm/s; 0: rapid
    void go(const Eigen::Vector3d& tip, double feed);
    /// Goes where a move goes, on its line or arc.
    void go(const CutterMove& move);
    /// What follows is in inches (G20) or mm.
    void set_inches(bool inches);
    /// The next move says its G word.
    void forget_motion() { motion_.clear(); }

  private:
    void block(const std::string& motion, const Eigen::Vector3d& tip, double feed, const std::string& centre);
    std::string number(double mm) const;

    std::ostream& out_;
    std::string motion_;
    Eigen::Vector3d at_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< mm
    double feed_ = 0;                                                                          ///< mm/s
    bool inches_ = false;
};

} // namespace fettle
