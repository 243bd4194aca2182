#pragma once

#include "core/progress.h"
#include "merge/pair.h"
#include "merge/scan.h"

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::merge {

using Scans = std::vector<std::unique_ptr<const Scan>>;

/// Where a scan lies among the others.
struct Place {
    Eigen::Isometry3d T_world_scan;
    double side = 1; ///< -1: the normals, whose outer side is unknown, point the other way from those of the world
};

/// The pose of one scan on another by these places.
PairPose pose_between(const Place& a, const Place& b);

/// Something that was found and is not used.
struct Refusal {
    std::size_t a = 0;            ///< index of a scan
    std::optional<std::size_t> b; ///< of the other scan, if it is a pair that is refused
    std::string reason;
};

/// Scans put together, a rough solution.
struct Growth {
    std::vector<std::optional<Place>> places; ///< of each scan; nothing: it fits nowhere
    std::vector<Refusal> refused;
};

/// Puts scans together from any start: from one scan on, the surest pair of a placed and another scan is joined, unless
/// the scan would then contradict one of those already placed; a less sure pair needs a second placed scan that agrees.
/// If most scans are left over, growth begins anew among them; the largest group stays. The world is the frame of the
/// group's first scan.
/// @param length  of the cubes of the means, mm
Growth grow(const Scans& scans, double length, const core::Progress& progress);

} // namespace fettle::merge
