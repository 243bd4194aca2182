#pragma once

#include "core/decompositions.h"
#include "job/job.h"
#include "sampling/scan.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::margin {

/// Heights of the metal around the anomaly, where a scan has them: at the cell centres of a grid over S that lie
/// outside B.
/// @return  3xN, M, mm
/// @throws InputError for fewer than 40 heights: they would not tell waves from the scan's noise. @param source  the
///         scan's name in messages
Eigen::Matrix3Xd heights_around_anomaly(const sampling::Scan& scan, const job::Job& job, const std::string& source);

/// Waves of one amplitude (standard deviation) and one correlation length.
struct WaveSize {
    double amplitude; ///< mm; 0: no waves
    double length;    ///< mm
    double probability;
};

/// How large the waves about a surface are that a scan shows. A scanner may be off by more than a touch, far more than
/// the waves are high, but as a smooth function of place; so the scan says nothing about where the surface is, and all
/// about the waves' size.
class ScanWaves {
  public:
    /// @param heights  3xN, mm   @param lengths  of the waves (Matérn, ν = 5/2), mm
    ScanWaves(const Eigen::Matrix3Xd& heights, const std::vector<double>& lengths);

    Eigen::Matrix2Xd places() const { return heights_.topRows<2>(); }
    auto z() const { return heights_.row(2).transpose(); }

    /// Posterior of amplitudes and lengths by the restricted likelihood (Patterson and Thompson 1971) of
    /// z = F β + g + e with waves g and noise e, whose deviation is summed over. Heights that are far off, by 6
    /// standard deviations of the others, are left out.
    /// @param trend  F, N x p   @param residuals  z less the surface, mm   @param share  prior probability of waves
    std::vector<WaveSize> sizes(const Eigen::MatrixXd& trend, const Eigen::VectorXd& residuals, double share) const;

  private:
    Eigen::Matrix3Xd heights_;
    std::vector<double> lengths_;
    std::vector<core::SymmetricEigen<Eigen::Dynamic>> correlations_; ///< of the heights, for each length
};

} // namespace fettle::margin
