#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

namespace fettle {

/// Normals of the displaced surface.
struct DisplacedNormals {
    Eigen::Matrix3Xd normal;       ///< unit; where there are no u-v neighbours to tell, the design's
    Eigen::Index undetermined = 0; ///< of these
    Eigen::Index beyond = 0;       ///< surfels where |D| times the design's curvature exceeds kLargestBend
    double largest_bend = 0;       ///< the largest |D| times curvature
};

/// The formula leaves out the product of the displacement and the normal's own turning: it is good to |D| times
/// curvature, relative to the slope.
inline constexpr double kLargestBend = 0.1;

/// By perturbation (Blinn 1978; Ren et al. 2006, eq. 4):
///     N' = P_u × P_v + D_u (n × P_v) + D_v (P_u × n)
/// with P the design over (u, v), D the displacement, n the unit normal. As printed there the last product has its
/// factors the other way round, which turns the slope along v over. The derivatives are those of local_fit().
DisplacedNormals displaced_normals(const Surfels& surfels);

} // namespace fettle
