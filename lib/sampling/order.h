#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::sampling {

/// Speeds of a probing machine. The defaults suit a gantry with a touch-trigger probe as in Wang 2007, 4.4 (0.005 in);
/// the approach is slow enough not to damage the probe.
struct ProbingMachine {
    double travel_speed =
        50.8; ///< speed between touches and down to the approach, mm/s: 2 in/s, twice the grinding feed
    double approach_speed = 5.0; ///< speed in search of the surface, mm/s: it stops within a few hundredths of a mm
    double approach_clearance =
        10.0;           ///< height above the highest touch at which the approach begins, mm: the part is not known
    double dwell = 0.5; ///< dwell at each touch, s: stop, read, reverse
};

/// Short open path through all touches: nearest neighbours from every start, each improved by 2-opt. Deterministic: of
/// equally short paths the touches' indices decide.
/// @param xy  2xN, mm
/// @return indices of the touches in order of travel
std::vector<Eigen::Index> short_probing_path(const Eigen::Matrix2Xd& xy);

/// Length of the path in x-y, mm.
double probing_path_length(const Eigen::Matrix2Xd& xy, const std::vector<Eigen::Index>& order);

/// Time to probe the touches in the given order, s: travel at the safe height, down to the approach height, approach to
/// the surface, and up again.
/// @param touches  3xN, M, mm; NaN in z stands for the highest of the others (0 if there is none)
double probing_time(const Eigen::Matrix3Xd& touches, const std::vector<Eigen::Index>& order, double safe_height,
                    const ProbingMachine& machine = {});

} // namespace fettle::sampling
