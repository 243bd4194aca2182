#pragma once

#include "belt/press.h"
#include "cloud/cloud.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace fettle::belt {

/// A contact point of a belt path. A run is the part of the path from a touchdown to the next lift-off.
struct BeltPoint {
    Eigen::Isometry3d T_part_tool; ///< NaN: the wheel is off the part; the next point begins another run
    ContactLoad load;
    double feed = 0;           ///< V_w, mm/s
    double dwell = 0;          ///< time at rest on this point, in addition to the motion, s
    bool touches_down = false; ///< the wheel came down here and did not slide here from the point before

    bool is_on_part() const { return T_part_tool.matrix().allFinite(); }
};

/// Values for points of a path that has no fields for them.
struct BeltSettings {
    std::optional<double> force, depth; ///< N, mm; not both; they override the fields of the path
    double feed = 20;                   ///< mm/s
    double dwell = 0;                   ///< at both ends of each run, in addition to the field dwell, s
};

/// A belt path from poses and the fields force, depth, feed, dwell, pass and stroke. Each pass is a run of its own;
/// points of a negative stroke are off the part. At each point the depth holds if there is one, otherwise the force;
/// the other of the two may be NaN.
/// @throws InputError if a point has neither force nor depth, or a value is not positive
std::vector<BeltPoint> belt_path(const cloud::Cloud& path, const BeltSettings& settings);

/// First point of the pass after the one that `point` is in. A pass is the path from a touchdown to the next.
std::size_t end_of_pass(const std::vector<BeltPoint>& path, std::size_t point);

/// Tributary length of each point, mm: half the distance to each of its neighbours in the same run; 0 where the wheel
/// is off the part.
Eigen::VectorXd tributary_lengths(const std::vector<BeltPoint>& path);

} // namespace fettle::belt
