#pragma once

#include "gantry/gantry.h"
#include "job/job.h"

#include <Eigen/Core>

#include <string>

namespace fettle::strategy {

/// A peak above this share of F_max is worth a warning: what is less is the way of one reading.
inline constexpr double kMaxPeakShare = 1.15;

/// How a run has kept the limits of the force.
struct ForceRecord {
    double peak = 0;                                   ///< N
    Eigen::Vector3d peak_at = Eigen::Vector3d::Zero(); ///< tip of the wheel at the end of that move, frame M, mm
    int peak_layer = 1;
    double contact_time = 0; ///< of grinding above layer 1 with a force, s
    double in_range = 0;     ///< share of it with a force from F_min to F_max; 0 without contact

    /// Takes in a move. @param duration  of grinding, s; 0: it did not grind
    void add(const gantry::GantryStatus& status, int layer, double duration, const job::ForceRange& limits);
};

/// What to warn of, in the units of the job: a peak that is far above F_max, and where. Empty: nothing.
std::string peak_warning(const ForceRecord& record, const job::Job& job);

} // namespace fettle::strategy
