#pragma once

#include "align/oriented_points.h"
#include "align/rigid.h"

#include <vector>

namespace fettle {

/// A place of the scan, and how badly it fits there.
struct Pose {
    Eigen::Isometry3d T_reference_scan;
    double cost = 0; ///< mean robust squared distance, as a share of its bound: 0 perfect, 1 nowhere near
};

/// Looks for the scan on the reference, wherever it lies: from turns that cover all rotations, laid out from the
/// principal axes of both with every choice of their order and signs among them, and where the scan is smaller, from
/// places all over the reference, it descends to the nearest good fit. The start pose makes no difference but rounding.
/// @param scan   3xN, mm
/// @param about  the scan's frame of motions
/// @param held  turns about one axis: those alone; held shifts: none
/// @return  distinct poses, best first
std::vector<Pose> search_poses(const Eigen::Matrix3Xd& scan, const TwistFrame& about, const OrientedPoints& reference,
                               const HeldAxes& held);

/// How far apart two poses put the scan, mm: the shift of its centre and the way of a point one radius from it.
double distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const TwistFrame& about);

} // namespace fettle
