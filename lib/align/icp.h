#pragma once

#include "align/reference.h"
#include "align/rigid.h"

#include <optional>

namespace fettle {

struct IcpOptions {
    HeldAxes held{};
    std::optional<double> max_distance; ///< points farther from the reference do not overlap it, mm
    std::optional<double> overlap;      ///< share of the points that do; neither given: found anew in every step
    int iterations = 200;
};

/// The scan on its reference.
struct IcpFit {
    Eigen::Isometry3d T_reference_scan;
    bool converged = false;
    int iterations = 0;
    double cut = 0;     ///< points within it overlap, mm
    double overlap = 0; ///< share of the points within it
    double sigma = 0;   ///< robust standard deviation of the distances across the reference, mm
    double misfit = 0;  ///< what trimming makes least: a mean square, mm², by which two poses of a scan compare
    TwistMatrix information = TwistMatrix::Zero(); ///< sum of w g gᵀ about the scan's centroid as it lies now
    double least_information = 0;                  ///< eigenvalues below it are made by what normals are wrong by
};

/// Iterative closest points, point to plane (Chen & Medioni 1992), trimmed (Chetverikov et al. 2005) and robust: of
/// the points that overlap, those off by more than the noise are weighed down (Tukey's biweight).
/// @param start  T_reference_scan   @param scan  3xN, mm   @param about  the scan's frame of motions
IcpFit icp(const Eigen::Isometry3d& start, const Eigen::Matrix3Xd& scan, const TwistFrame& about,
           const AlignReference& reference, const IcpOptions& options);

/// Distances of the scan's points from the reference: to the closest point, and across it.
struct Distances {
    Eigen::VectorXd closest; ///< >= 0, mm
    Eigen::VectorXd across;  ///< along the reference's normal at the foot, mm
    Eigen::Matrix3Xd normal; ///< there, unit
};
/// @param points  3xN, mm, in the reference's frame
Distances distances(const Eigen::Matrix3Xd& points, const AlignReference& reference);

/// Where a scan ends to overlap, and how badly it fits as far as that: the share x of its points whose mean square
/// distance over x³ is least (Chetverikov et al. 2005).
struct Trim {
    double cut = 0;    ///< mm
    double misfit = 0; ///< that least value, mm²
};
/// @param floor  what rounding makes of a distance of none, mm
Trim trim(Eigen::VectorXd closest, double floor);

} // namespace fettle
