#pragma once

#include "sampling/hillclimb.h"
#include "sampling/scan.h"

#include <Eigen/Core>

namespace fettle {

/// Touches on a surface that is known also beneath the anomaly: what a search for the best touches looks at.
struct KnownSurface {
    Eigen::Matrix3Xd candidates; ///< touches to choose from, M, mm
    Eigen::Matrix3Xd always;     ///< used with any choice (estimated points, Wang 2007, Table 4-1); may be empty
    Eigen::Matrix2Xd inside;     ///< places inside B, M, mm
    Eigen::VectorXd truth;       ///< z of the surface there, mm
    double angle = 0;            ///< from X_m to X_w, rad
};

/// Touches a known surface without error: the part as it is without the anomaly.
/// @param spacing  of the candidates, mm; 0: as candidate_touches says. Those without a surface beneath are left out.
/// @throws InputError naming a place inside B without a surface
KnownSurface touch_known_surface(const Scan& surface, const Job& job, double spacing);

/// The error band inside B (Wang 2007, eq. 4-1) of the modified griddata through a subset of the candidates; infinite
/// where B is not inside their hull. @param spacing  of its uniform sampling, mm
SubsetError griddata_band(const KnownSurface& known, double spacing);

/// The same of the modified tensor B-spline.
SubsetError tensor_bspline_band(const KnownSurface& known);

} // namespace fettle
