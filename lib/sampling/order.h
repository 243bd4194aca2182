#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// How fast the machine probes. The defaults suit a gantry with a touch-trigger probe of the kind that Wang 2007, 4.4
/// quotes (0.005 in): slow enough on the last millimetres that the probe survives the touch.
struct ProbingMachine {
    double travel = 50.8;    ///< between touches and down to the approach, mm/s: 2 in/s, twice the grinding feed
    double approach = 5.0;   ///< in search of the surface, mm/s: it stops within a few hundredths of a mm
    double clearance = 10.0; ///< the approach begins that far above the highest touch, mm: the part is not known
    double settle = 0.5;     ///< at each touch, s: stop, read, turn back
};

/// A way through all touches, open at both ends: nearest neighbour from every start, each bettered by 2-opt.
/// Deterministic; ways that are equally short are told apart by the touches' numbers.
/// @param xy  2xN, mm
/// @return indices in order of travel
std::vector<Eigen::Index> short_way(const Eigen::Matrix2Xd& xy);

/// Length of the way in x-y, mm.
double way_length(const Eigen::Matrix2Xd& xy, const std::vector<Eigen::Index>& order);

/// Time to probe the touches in the given order, s: across at the job's safe height, down at travelling speed, the last
/// part in search of the surface, and up again.
/// @param touches  3xN, M, mm; where z is NaN the highest of the others is taken (0 if there is none)
double probing_time(const Eigen::Matrix3Xd& touches, const std::vector<Eigen::Index>& order, double safe_height,
                    const ProbingMachine& machine = {});

} // namespace fettle
