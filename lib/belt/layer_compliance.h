#pragma once

#include <Eigen/Core>

namespace fettle::belt {

/// An elastic layer bonded to a rigid hub.
struct ElasticLayer {
    double thickness = 0; ///< h, mm; infinite: a half-space
    double young = 0;     ///< Young's modulus E, MPa
    double poisson = 0;   ///< Poisson's ratio ν, 0 … 0.5; 0.5 is incompressible
};

/// Influence coefficients of the flat layer: displacement into the layer, mm, at the centre of cell (i, j) under a
/// pressure of 1 MPa on cell (0, 0) alone. The half-space part is Love's formula (1929; Johnson 1985, 3.3). The effect
/// of the hub is the Hankel transform of the difference of both compliances (Bentall and Johnson 1968; Johnson
/// 1985, 5.8),
///     C(q) = 2(1-ν²)/(E q) · [(3-4ν) sinh 2qh - 2qh] / [(3-4ν) cosh 2qh + 2(qh)² + 5 - 12ν + 8ν²].
/// The layer has no edges.
/// @param cell  size, mm   @return  rows x columns; the field is even in i and j
/// @throws InputError if thickness, modulus or ratio are out of range
Eigen::MatrixXd influence_coefficients(const ElasticLayer& layer, const Eigen::Vector2d& cell, Eigen::Index rows,
                                       Eigen::Index columns);

} // namespace fettle::belt
