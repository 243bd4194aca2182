#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// Nearest surfels among which those of the patch are looked for: on an edge half of them are another patch's, and many
/// lie along it.
inline constexpr Eigen::Index kFitCandidates = 32;

/// A workpiece about a place (u, v) of a patch.
struct LocalFit {
    Eigen::Vector3d P, n;               ///< place on the design, its normal (not quite unit)
    double D = 0;                       ///< displacement
    Eigen::Vector3d P_u, P_v, n_u, n_v; ///< derivatives in u and v
    double D_u = 0, D_v = 0;
};

/// Quadratics in u and v by least squares through the surfels of a patch about a place; on a regular lattice the
/// derivatives are central differences. Nothing where there are too few, or these lie on a line.
/// @param candidates  nearest first; those of other patches and those without displacement are passed over
std::optional<LocalFit> local_fit(const Surfels& surfels, int patch, const Eigen::Vector2d& uv,
                                  const std::vector<Eigen::Index>& candidates);

} // namespace fettle
