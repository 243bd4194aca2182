#pragma once

#include "fit/process_spectrum.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace fettle {

/// Functions of x and y by their control heights on a grid: c_i = (f_{i-2} - 10 f_{i-1} + 54 f_i - 10 f_{i+1} +
/// f_{i+2}) / 36 from their values at the Greville abscissae and two beyond each end is exact for cubics
/// (quasi-interpolant: de Boor 2001, XII) and nearly the interpolant for what bends within four cells.
class ControlHeights {
  public:
    explicit ControlHeights(const Bspline& grid);

    Eigen::Index size() const { return rows_ * columns_; }
    /// Where functions are to be evaluated.
    const Eigen::Matrix2Xd& nodes() const { return nodes_; }
    /// Of functions whose values at the nodes are given, one a column.
    Eigen::MatrixXd from(const Eigen::MatrixXd& values) const;
    /// Correlation of two control heights, by how many rows and columns lie between them.
    Eigen::MatrixXd correlation_between(const Correlation& correlation) const;
    /// All of them with all: the lower half of the matrix.
    void add_by_place(Eigen::MatrixXd& sum, const Eigen::MatrixXd& between) const;

  private:
    Eigen::Index rows_, columns_;
    Eigen::Vector2d cell_;
    Eigen::Matrix2Xd nodes_;
};

/// Mean and covariance of control heights, over processes of several correlations and amplitudes. All amplitudes of one
/// correlation share its decomposition: with the trend F = Q R, K the touches' correlation, C the controls' with the
/// touches and F_c the trend's controls over R,
///     mean = F_c Qᵀ z + B v,   v = (τ²/σ) (1 + (τ/σ)² λ)⁻¹ y,   B = (C - F_c Qᵀ K) E,
///     covariance = τ² (correlation - C Q F_cᵀ - F_c Qᵀ Cᵀ + F_c Qᵀ K Q F_cᵀ) + σ² F_c F_cᵀ - B τ⁴ (σ² + τ² λ)⁻¹ Bᵀ.
class ProcessMixture {
  public:
    /// @param trend  control heights of the trend's functions, one a column. All are kept by reference.
    ProcessMixture(const ProcessTouches& touches, const ControlHeights& controls, const Eigen::MatrixXd& trend);

    /// @param weights  of the amplitudes; they need not sum to 1
    void add(const Spectrum& s, const std::array<double, kRatios>& weights);

    /// @return  mean and covariance
    std::pair<Eigen::VectorXd, Eigen::MatrixXd> result() const;

  private:
    /// covariance = Σ left rightᵀ: many of them are one product in the end.
    struct Part {
        double weight;
        Eigen::VectorXd mean;
        Eigen::MatrixXd left, right;
    };

    const ProcessTouches& touches_;
    const ControlHeights& controls_;
    Eigen::MatrixXd Q_, F_;
    Eigen::VectorXd trend_;
    Eigen::MatrixXd between_; ///< ControlHeights::correlation_between(), times τ², summed
    std::vector<Part> parts_;
};

} // namespace fettle
