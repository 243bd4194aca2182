#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::margin {

/// A family of surfaces with waves about it that few touches do not show: a Gaussian process of one amplitude and one
/// length.
struct Waves {
    double probability = 0; ///< that the part has these, if it is of the family
    Eigen::VectorXd offset; ///< mean of the heights over the family's alone, mm
    Eigen::MatrixXd root;   ///< F with F Fᵀ the heights' covariance
};

/// Castings have waves of their own, and families none. So one part in four is taken to have some before it is touched:
/// of four times the standard deviation of a touch, the highest that a dozen touches may hide, a quarter to all of the
/// touches' radius long, all alike (Matérn, ν = 5/2). No part is designed as a cubic: where one explains the touches,
/// nine parts in ten have them. The touches then say how likely which are, and how they go on inside the anomaly
/// (universal kriging: Cressie 1993, 3.4; restricted likelihood: Patterson and Thompson 1971).
/// Touches that the fit left out may be gross errors (outlier_penalty()), or have seen waves: with them, waves of 8, 16
/// and 32 times that deviation are weighed, too, each with the odds to none that those of four have. They would leave
/// no family without such touches.
/// @param member  a family fitted to the surface's touches   @param xy  2xN, M, mm
/// @return  those that matter; their probabilities leave the rest to the family without waves. Nothing where the
///          touches leave no degree of freedom, or the family is not defined.
std::vector<Waves> waves_about(const surface::WeightedShape& member, const surface::Surface& surface,
                               const Eigen::Matrix2Xd& xy);

} // namespace fettle::margin
