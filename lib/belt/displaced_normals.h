#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Normals of the displaced surface.
struct DisplacedNormals {
    Eigen::Matrix3Xd normal;       ///< unit; the design's where too few neighbours determine the derivatives
    Eigen::Index undetermined = 0; ///< surfels with the design's normal
    Eigen::Index above_limit = 0; ///< surfels with |D| κ > kMaxDisplacementCurvature, κ the larger principal curvature
    double max_displacement_curvature = 0; ///< max. |D| κ
};

/// Limit of displacement times curvature, |D| κ, for accurate normals. The formula neglects the product of the
/// displacement and the derivative of the normal: its error relative to the slope is |D| κ.
inline constexpr double kMaxDisplacementCurvature = 0.1;

/// Normals by perturbation (Blinn 1978; Ren et al. 2006, eq. 4):
///     N' = P_u × P_v + D_u (n × P_v) + D_v (P_u × n)
/// with P the design over (u, v), D the displacement, n the unit normal. The paper prints the factors of the last
/// product in reverse order, which inverts the slope along v. Derivatives come from local_fit().
DisplacedNormals displaced_normals(const Surfels& surfels);

} // namespace fettle::belt
