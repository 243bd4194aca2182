#pragma once

#include "align/reference.h"
#include "align/rigid.h"

#include <optional>

namespace fettle::align {

struct IcpOptions {
    HeldAxes held{};
    std::optional<double> max_distance; ///< points farther from the reference do not overlap it, mm
    std::optional<double> overlap; ///< share of points that overlap; without either, trimming finds it in every step
    int max_iterations = 200;      ///< at most
};

/// A pose of the scan on the reference.
struct IcpFit {
    Eigen::Isometry3d T_reference_scan;
    bool converged = false; ///< the steps have become short, and the scan lies on the reference
    int iterations = 0;
    double cutoff = 0;  ///< largest distance from the reference at which a point overlaps it, mm
    double overlap = 0; ///< share of the points within that distance
    double sigma = 0;   ///< robust standard deviation of the distances along the normals, mm
    double misfit = 0;  ///< objective of trimming, mm²: the mean square distance by which poses of a scan are compared
    TwistMatrix information = TwistMatrix::Zero(); ///< Σ w g gᵀ about the scan's centroid in the final pose
    double min_information = 0; ///< eigenvalues below it may stem from errors of the normals: undetermined
};

/// Point-to-plane ICP (Chen & Medioni 1992), trimmed (Chetverikov et al. 2005) and robust: Tukey's biweight reduces the
/// weight of overlapping points whose distance exceeds the noise. pcl::IterativeClosestPoint registers to a cloud only,
/// holds no axes fixed, and inverts the normal matrix even where the points leave a motion undetermined.
/// @param start  T_reference_scan   @param scan  3xN, mm   @param scan_frame  twist_frame() of the scan
IcpFit icp(const Eigen::Isometry3d& start, const Eigen::Matrix3Xd& scan, const TwistFrame& scan_frame,
           const AlignReference& reference, const IcpOptions& options);

/// Distances of the scan's points from their feet on the reference.
struct FootDistances {
    Eigen::VectorXd absolute;     ///< to the foot, >= 0, mm
    Eigen::VectorXd along_normal; ///< component along the normal at the foot, mm
    Eigen::Matrix3Xd normals;     ///< of the reference at the feet, unit
};
/// @param points  3xN, mm, in the reference's frame
FootDistances foot_distances(const Eigen::Matrix3Xd& points, const AlignReference& reference);

/// Overlap of a scan with its reference, estimated by trimming: the share x of the points, nearest first, that
/// minimises their mean square distance over x³ (Chetverikov et al. 2005).
struct Trim {
    double cutoff = 0; ///< largest distance within the overlap, mm
    double misfit = 0; ///< the minimum, mm²
};
/// @param absolute  distances, mm   @param rounding  that a distance of zero may have, mm
Trim estimate_overlap(Eigen::VectorXd absolute, double rounding);

} // namespace fettle::align
