#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "removal/wheel.h"

#include <Eigen/Core>

namespace fettle::strategy {

/// Watches that a wheel which grinds into the stock, as far as that is known, also feels it. A transducer that is dead
/// would let the strategy find everything within tolerance.
///
/// By Preston's law the stock over the wheel takes a force. It may be several times smaller than the job's removal
/// coefficient says, and the stock may be a little off its place; but it is there.
class ContactWatch {
  public:
    ContactWatch(const removal::HeightField& stock, const job::Job& job);
    ContactWatch(const ContactWatch&) = delete;
    ContactWatch& operator=(const ContactWatch&) = delete;

    /// Follows a move of the machine. @param feed  mm/s; 0: it did not grind
    /// @throws GantryFault if the head has not felt the stock that the wheel has gone through
    void follow(const gantry::GantryStatus& status, double feed);

  private:
    double remove_to(const Eigen::Vector3d& tip);

    removal::HeightField stock_;
    removal::WheelInStock wheel_;
    Eigen::Matrix2d R_working_machine_;
    double radius_, width_; ///< of the wheel, mm
    double tolerance_;      ///< of the ground surface, mm
    double removal_;        ///< c, mm³/(N s)
    double preload_;        ///< N: smaller forces may not be felt
    double min_force_;      ///< N: that every working transducer shows
    double max_unfelt_;     ///< length without a force, mm
    Eigen::Vector3d tip_;   ///< of the wheel, after the last move
    double time_ = 0;       ///< then, s
    double last_force_ = 0; ///< then, N
    double unfelt_ = 0;     ///< length that the wheel has gone through the stock since it felt something, mm
    bool has_tip_ = false;
};

} // namespace fettle::strategy
