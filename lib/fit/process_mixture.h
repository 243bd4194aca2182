#pragma once

#include "fit/process_spectrum.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace fettle::fit {

/// Control heights of functions of x and y on a grid by a quasi-interpolant (de Boor 2001, XII): c_i = (f_{i-2} - 10
/// f_{i-1} + 54 f_i - 10 f_{i+1} + f_{i+2}) / 36 with the values at the Greville abscissae and two more beyond each
/// end. It is exact for cubics and close to the interpolant for functions that bend within four cells.
class ControlHeights {
  public:
    explicit ControlHeights(const surface::Bspline& grid);

    Eigen::Index size() const { return rows_ * columns_; }
    /// The places at which the functions must be evaluated, 2xM, M, mm.
    const Eigen::Matrix2Xd& nodes() const { return nodes_; }
    /// Control heights, one column for each column of function values at the nodes.
    Eigen::MatrixXd from_values(const Eigen::MatrixXd& values) const;
    /// Correlations of the control heights with the process at some points.
    /// @param squared  of the nodes' distances from the points, mm²
    Eigen::MatrixXd correlation_with(const Correlation& correlation, const Eigen::Matrix2Xd& points,
                                     const Eigen::MatrixXd& squared) const;
    /// Correlation of two control heights; entry (p, q) is for p rows and q columns between them.
    Eigen::MatrixXd correlation_by_offset(const Correlation& correlation) const;
    /// Adds the block Toeplitz matrix of correlations by offset to the lower triangle of a covariance.
    void add_block_toeplitz(Eigen::MatrixXd& sum, const Eigen::MatrixXd& by_offset) const;

  private:
    Eigen::Index rows_, columns_;
    Eigen::Vector2d cell_, origin_;
    double angle_;
    Eigen::Matrix2Xd nodes_;
};

/// Mean and covariance of the control heights of a mixture of processes with several correlations and amplitudes. All
/// amplitudes of one correlation share its decomposition. With the trend F = Q R, K the correlation matrix of the
/// touches, C that of the control heights with the touches and F_c the trend's control heights times R⁻¹,
///     mean = F_c Qᵀ z + B v,   v = (τ²/σ) (1 + (τ/σ)² λ)⁻¹ y,   B = (C - F_c Qᵀ K) E,
///     covariance = τ² (correlation - C Q F_cᵀ - F_c Qᵀ Cᵀ + F_c Qᵀ K Q F_cᵀ) + σ² F_c F_cᵀ - B τ⁴ (σ² + τ² λ)⁻¹ Bᵀ.
/// @param trend    control heights of the trend's functions, one column each
/// @param weights  of each spectrum's amplitudes; they need not sum to 1
/// @return  mean and covariance
std::pair<Eigen::VectorXd, Eigen::MatrixXd> mix_processes(const ProcessTouches& touches, const ControlHeights& controls,
                                                          const Eigen::MatrixXd& trend,
                                                          const std::vector<Spectrum>& spectra,
                                                          const std::vector<std::array<double, kNumRatios>>& weights);

} // namespace fettle::fit
