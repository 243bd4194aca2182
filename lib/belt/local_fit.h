#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::belt {

/// Number of nearest surfels to pass to local_fit(). At an edge half of them belong to another patch, and many lie
/// along the edge.
inline constexpr Eigen::Index kFitCandidates = 32;

/// The design and its displacement near a point (u, v) of a patch.
struct LocalFit {
    Eigen::Vector3d P, n;               ///< point on the design, mm; its normal, only approximately unit
    double D = 0;                       ///< displacement, mm
    Eigen::Vector3d P_u, P_v, n_u, n_v; ///< derivatives in u and v
    double D_u = 0, D_v = 0;
};

/// Least-squares quadratics in u and v through the surfels of a patch near a point; on a regular lattice the
/// derivatives are central differences. Returns nothing for too few or collinear surfels.
/// @param candidates  nearest first; surfels of other patches or without displacement are skipped
std::optional<LocalFit> local_fit(const Surfels& surfels, int patch, const Eigen::Vector2d& uv,
                                  const std::vector<Eigen::Index>& candidates);

} // namespace fettle::belt
