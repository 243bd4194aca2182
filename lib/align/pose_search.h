#pragma once

#include "align/icp.h"
#include "align/oriented_points.h"
#include "align/rigid.h"

#include <algorithm>
#include <vector>

namespace fettle::align {

/// A candidate pose of the scan, and how badly the scan fits there.
struct PoseCandidate {
    Eigen::Isometry3d T_reference_scan;
    double cost = 0; ///< mean robust squared distance over its upper bound: 0 exact, 1 every point far away
};

/// Global registration: searches the pose of the scan on the reference without a start pose. Robust descents begin at
/// rotations that cover SO(3), laid out from the principal axes of both with every permutation and sign of the axes
/// among them, and, where the scan is smaller, at positions all over the reference; and at the poses that
/// match_point_pairs() finds, if no axis is held. Up to rounding the result does not depend on the pose in which the
/// scan is given.
/// @param frame    twist_frame() of the scan
/// @param options  with one free rotation axis, only rotations about it are tried; held shifts are not searched; the
/// costs take the overlap and the maximum distance into account
/// @return  the best poses of either kind, each kind distinct, best first
std::vector<PoseCandidate> search_poses(const OrientedPoints& scan, const TwistFrame& frame,
                                        const OrientedPoints& reference, const IcpOptions& options);

/// Distance of two poses of the scan, mm: the shift of its centre plus the arc of a point one radius away from it.
double pose_distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const TwistFrame& frame);

/// Sorts candidates by ascending `score` and drops each that lies within `radii` scan radii of a better one.
/// @return  the best `max_count` of those that remain
template <typename Candidate>
std::vector<Candidate> distinct_poses(std::vector<Candidate> candidates, double Candidate::*score,
                                      const TwistFrame& frame, double radii, std::size_t max_count)
{
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) { return a.*score < b.*score; });
    std::vector<Candidate> distinct;
    for (const Candidate& candidate : candidates) {
        if (distinct.size() == max_count) break;
        const auto duplicates = [&](const Candidate& better) {
            return pose_distance(candidate.T_reference_scan, better.T_reference_scan, frame) < radii * frame.radius;
        };
        if (std::none_of(distinct.begin(), distinct.end(), duplicates)) distinct.push_back(candidate);
    }
    return distinct;
}

} // namespace fettle::align
