#pragma once

#include "sampling/hillclimb.h"
#include "sampling/scan.h"

#include <Eigen/Core>

namespace fettle::margin {

/// Candidate touches on a surface that is also known beneath the anomaly, for the search for the best touches.
struct KnownSurface {
    Eigen::Matrix3Xd candidates; ///< M, mm
    Eigen::Matrix3Xd
        fixed_touches; ///< part of every subset (estimated points, Wang 2007, Table 4-1), M, mm; may be empty
    Eigen::Matrix2Xd anomaly_places; ///< places inside B, M, mm
    Eigen::VectorXd true_heights;    ///< z of the surface there, mm
    double angle = 0;                ///< from X_m to X_w, rad
};

/// Touches a known surface, the part without its anomaly, without error.
/// @param spacing  of the candidates, mm; 0: the default of candidate_touches(). Those off the surface are left out.
/// @throws InputError naming a place inside B without a surface
KnownSurface touch_known_surface(const sampling::Scan& surface, const job::Job& job, double spacing);

/// The error band inside B (Wang 2007, eq. 4-1) of the modified griddata through a subset of the candidates; infinite
/// where B is not inside their hull. @param spacing  of its uniform sampling, mm
sampling::SubsetError griddata_band(const KnownSurface& known, double spacing);

/// The error band inside B of the modified tensor B-spline through a subset of the candidates; infinite if they do not
/// determine it.
sampling::SubsetError tensor_bspline_band(const KnownSurface& known);

} // namespace fettle::margin
