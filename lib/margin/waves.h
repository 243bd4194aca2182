#pragma once

#include "margin/scan_waves.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::margin {

/// Waves about a member of a fit that few touches do not show: a Gaussian process of one amplitude and one
/// correlation length.
struct Waves {
    double probability = 0; ///< posterior, if the part is as the member says
    Eigen::VectorXd offset; ///< mean of the heights minus those of the member alone, mm
    Eigen::MatrixXd root;   ///< F with F Fᵀ the heights' covariance
};

/// Lengths of the waves that are considered, mm: parts of the distance of the farthest touch from the middle of those
/// that the fit kept.
std::vector<double> wave_lengths(const surface::Surface& surface);

/// Castings have waves of their own, and families none. A priori one part in four has waves: of four times the standard
/// deviation of a touch, the highest that a dozen touches may hide, with lengths of a quarter to all of the touches'
/// radius, equally probable (Matérn, ν = 5/2). No part is designed as a cubic: where one fits the touches, nine parts
/// in ten have waves. The posterior given the touches yields their probabilities and their heights inside the anomaly
/// (universal kriging: Cressie 1993, 3.4; restricted likelihood: Patterson and Thompson 1971).
/// Touches that the fit left out may be outliers (outlier_penalty()), or be explained by waves: given these touches,
/// waves of 8, 16 and 32 times that deviation are considered, too, each with the prior odds of those of four times.
/// Without such touches they are not, since they would leave no probability to any family.
/// A scan of the metal around the anomaly says how large the waves are; then these sizes are the prior instead.
/// A process has waves of its own, whose size it has from the touches. With a scan it is known better: then they are
/// waves about the process's trend, a quadratic, of the sizes that the scan shows; without one there are none beside.
/// @param member  a family or a process fitted to the surface's touches   @param xy  2xN, M, mm   @param scan  may be
///                null; of the lengths of wave_lengths()
/// @return  waves whose probability matters; the remaining probability is that of the member as it was fitted. Nothing
///          where the touches leave no degree of freedom, or the member is not defined.
std::vector<Waves> waves_about(const surface::WeightedShape& member, const surface::Surface& surface,
                               const Eigen::Matrix2Xd& xy, const ScanWaves* scan = nullptr);

} // namespace fettle::margin
