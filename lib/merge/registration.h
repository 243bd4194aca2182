#pragma once

#include "core/progress.h"
#include "merge/growth.h"
#include "merge/scan.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace fettle::merge {

/// The pose of a scan, and how well it is known.
struct ScanPose {
    Eigen::Isometry3d T_world_scan;
    /// Covariance of a small motion of the placed scan about its own centroid: shift, mm, then rotation vector, rad;
    /// along the axes of the world. Zero for the first one; infinite variances on the diagonal if not all poses are
    /// determined.
    align::TwistMatrix covariance = align::TwistMatrix::Zero();
    double side = 1; ///< as Place::side
};

/// Two scans that see the same surface.
struct PairFit {
    std::size_t a = 0, b = 0;
    double overlap_a = 0, overlap_b = 0; ///< shares of each scan that lie on the other
    double rms = 0;                      ///< of the offsets of means, mm
    double misfit = 0; ///< of the pair's own pose from that of all pairs, in standard deviations, over √6
};

struct Registration {
    std::vector<std::optional<ScanPose>> scans; ///< nothing: the scan fits nowhere
    std::vector<PairFit> pairs;
    std::vector<Refusal> refused; ///< in the order in which they were found
    double scatter = 0; ///< root mean square of the offsets over what the scans' noise explains: 1 if noise is all
    bool converged = false;
};

struct RegistrationRequest {
    double length = 0;                     ///< of the cubes of the means, mm
    std::vector<Eigen::Isometry3d> starts; ///< T_world_scan of each scan; empty: all poses are searched
    core::Progress progress;
};

/// Registers scans of one part: where each lies in the frame of the first. Pairs are found by grow(); then all pairs
/// that see the same surface are fitted to each other at once, point to plane, by a pose graph. Where m scans with
/// weights w see a place, the pair a, b gets w_a w_b / Σ w: the weighted squares of the pairs' offsets are then those
/// of the offsets from the common mean, and no noise counts twice. So the covariance follows from the noise.
/// @throws InputError if fewer than two scans fit each other
Registration register_scans(const Scans& scans, const RegistrationRequest& request);

} // namespace fettle::merge
