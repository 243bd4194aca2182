#pragma once

#include "fit/round_problem.h"
#include "surface/surface.h"

#include <utility>

namespace fettle {

/// Frame of the least-squares plane z(x, y) through the touches, at their centroid; its first column points along
/// `angle` (from X_m, rad) in x-y.
/// @throws InputError if the touches lie on one line in x and y
RoundFrame start_frame(const Eigen::Matrix3Xd& touches, double angle, const std::string& source);

/// Curvature of the least-squares paraboloid (round: of u² + v²; otherwise of v², across the first axis) in the frame;
/// > 0: convex.
double start_curvature(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, bool round);

/// Covariance of θ from independent vertical errors of the touches, for a fit of orthogonal distances with the weights
/// w: with d_i = n_z (z_i - f) to first order and g_i = ∂f/∂θ,
///     H = Σ w n_z² g gᵀ,   C = σ² H⁻¹ (Σ w² n_z⁴ g gᵀ) H⁻¹.
/// A θ_j that moves no touch by the touch error when it changes by 1 (the turn of a flat cylinder's axis, rad) is taken
/// as given if it is among `may_be_given`.
/// @throws InputError "touches do not determine …"
Eigen::MatrixXd round_covariance(const Surface& surface, const Eigen::VectorXd& weight,
                                 const std::vector<Eigen::Index>& may_be_given, const std::string& source);

/// Huber's weights of the orthogonal distances; NaN heights are refused: the touches do not lie on an upper side.
Eigen::VectorXd round_weights(const Surface& surface, double width, const std::string& source);

} // namespace fettle
