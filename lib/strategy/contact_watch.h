#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "removal/wheel.h"

#include <Eigen/Core>

namespace fettle::strategy {

/// Checks that the head reports a force while the wheel removes known stock. With a dead force transducer the strategy
/// would take the whole part for finished.
///
/// The force is predicted by Preston's law from the volume that the wheel removes. It may really be several times
/// smaller, since the removal coefficient is uncertain, and the stock may be slightly out of place; but it is not zero.
class ContactWatch {
  public:
    ContactWatch(const removal::HeightField& stock, const job::Job& job);
    ContactWatch(const ContactWatch&) = delete;
    ContactWatch& operator=(const ContactWatch&) = delete;

    /// Takes in the state after a move. @param feed  of the move, mm/s; 0: it did not grind
    /// @throws GantryFault if the head has reported too small a force over max_length_without_force_ of stock
    void follow(const gantry::GantryStatus& status, double feed);

  private:
    double remove_to(const Eigen::Vector3d& tip);

    removal::HeightField stock_;
    removal::WheelInStock wheel_;
    Eigen::Matrix2d R_working_machine_;
    double radius_, width_;           ///< of the wheel, mm
    double tolerance_;                ///< of the ground surface, mm
    double removal_;                  ///< c, mm³/(N s)
    double preload_;                  ///< of the head's spring, N: it may report smaller forces as none
    double min_force_;                ///< that any working transducer reports, N
    double max_length_without_force_; ///< mm
    Eigen::Vector3d tip_;             ///< of the wheel, after the last move
    double time_ = 0;                 ///< of the machine, after the last move, s
    double last_force_ = 0;           ///< after the last move, N
    double length_without_force_ = 0; ///< length of stock ground since the last sufficient force, mm
    bool has_tip_ = false;
};

} // namespace fettle::strategy
