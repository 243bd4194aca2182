#pragma once

#include "belt/press.h"
#include "cloud/cloud.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace fettle {

/// A contact point of a belt path.
struct BeltPoint {
    Eigen::Isometry3d T_part_tool; ///< NaN: the wheel is off the part; the next point begins another run
    Pressing pressing;
    double feed = 0;         ///< V_w, mm/s
    double dwell = 0;        ///< time that it stands there, besides, s
    bool begins_run = false; ///< the wheel came down here, and not along the way from the point before

    bool is_on() const { return T_part_tool.matrix().allFinite(); }
};

/// What holds for points of a path that do not say it themselves.
struct BeltSettings {
    std::optional<double> force, depth; ///< N, mm; not both; also for points that do say it
    double feed = 20;                   ///< mm/s
    double dwell = 0;                   ///< at both ends of each run, besides, s
};

/// From poses and the fields force, depth, feed, dwell and pass: another pass is another run. Where there is a depth it
/// holds, else the force: one of them may be NaN.
/// @throws InputError if nothing says how the wheel is pressed on, or a value is not positive
std::vector<BeltPoint> belt_path(const Cloud& path, const BeltSettings& settings);

/// The way that belongs to each point: half the ways to both its neighbours of the same run, mm; 0 where the wheel is
/// off the part.
Eigen::VectorXd ways(const std::vector<BeltPoint>& path);

} // namespace fettle
