#pragma once

#include "align/rigid.h"
#include "merge/scan.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace fettle::merge {

/// A mean of scan a and the nearest one of scan b.
struct Correspondence {
    Eigen::Index a, b;
    Eigen::Vector3d place;  ///< of a's mean, in b's frame, mm
    Eigen::Vector3d normal; ///< half-way between both normals, in b's frame
    double offset;          ///< of a's mean over b's along `normal`, mm
    double sideways;        ///< distance of both across `normal`, mm
};

/// Where a scan lies on another.
struct PairPose {
    Eigen::Isometry3d T_b_a;
    double side = 1; ///< -1: the normals of one of them, whose outer side is unknown, point into the material
};

/// Nearest means, no farther apart than `reach`, whose normals agree. With the sum of both normals as direction the
/// offset of two places on a surface vanishes up to third order of their distance (Rusinkiewicz, A symmetric objective
/// function for ICP, 2019).
/// @param chosen  means of a
std::vector<Correspondence> correspondences(const Scan& a, const Scan& b, const PairPose& pose, double reach,
                                            const std::vector<Eigen::Index>& chosen);

/// How well two scans agree where both have surface.
struct Agreement {
    double overlap_a = 0, overlap_b = 0; ///< shares of the means that lie on the other scan
    double agreeing = 0; ///< of the means near the other scan's surface, the share that lies on it, of the worse scan
    double parallel =
        0;          ///< share of the means that lie over or under the other surface, parallel to it: of the worse scan
    double rms = 0; ///< of the offsets of those that do, mm
    double tightness = 0;   ///< 1: the offsets vanish; 0: they fill all that is allowed, as those of chance do
    double information = 0; ///< eigenvalue of the least determined motion, per mean: 1 if all offsets showed it in full
};
/// @param length  of the cubes of the means, mm   @param every  of so many means one is looked at
Agreement agreement(const Scan& a, const Scan& b, const PairPose& pose, double length, Eigen::Index every = 1);

/// A pose that a pair may have, from the scans alone.
struct Hypothesis {
    PairPose pose;
    Agreement agreement;
    double score = 0; ///< shares of overlap and of agreement times tightness
};

/// Searches the poses of a on b from any start: pairs of points vote (align::match_point_pairs), ICP refines each, and
/// the agreement of all means chooses. @return  the best ones, distinct, best first
std::vector<Hypothesis> search_pair(const Scan& a, const Scan& b, double length);

/// Symmetric point-to-plane ICP, robust by Tukey's biweight, whose reach falls from `reach` to `length`.
/// @param iterations  number
PairPose refine_pair(const Scan& a, const Scan& b, PairPose pose, double reach, double length, int iterations,
                     const std::vector<Eigen::Index>& chosen);

/// Refines a pose with all means, and judges it.
Hypothesis judge_pair(const Scan& a, const Scan& b, const PairPose& start, double length);

/// Whether two scans agree in a pose, as far as they see the same; chance does it at times.
bool is_credible(const Agreement& agreement);
/// Whether in a pose the surface of one scan runs beside that of the other where both should be one.
bool is_contradiction(const Agreement& agreement);
/// Share of overlap and agreement times tightness, 0 to 1.
double score_of(const Agreement& agreement);

} // namespace fettle::merge
