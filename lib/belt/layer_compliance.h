#pragma once

#include <Eigen/Core>

namespace fettle {

/// An elastic layer bonded to a rigid hub.
struct ElasticLayer {
    double thickness = 0; ///< h, mm; infinite: a half-space
    double young = 0;     ///< E, MPa
    double poisson = 0;   ///< ν, 0 … 0.5; 0.5 does not change its volume
};

/// By how much the layer gives way under an even pressure of 1 MPa all over, mm/MPa: h (1+ν)(1-2ν) / (E (1-ν)).
double even_compliance(const ElasticLayer& layer);

/// Displacement of the layer's flat surface, mm into the layer, at the middle of cell (i, j) for a pressure of 1 MPa on
/// cell (0, 0) alone: of the half-space by Love's formula (1929; Johnson 1985, 3.3), of what the hub holds back by the
/// Hankel transform of the difference of both compliances (Bentall and Johnson 1968; Johnson 1985, 5.8),
///     C(q) = 2(1-ν²)/(E q) · [(3-4ν) sinh 2qh - 2qh] / [(3-4ν) cosh 2qh + 2(qh)² + 5 - 12ν + 8ν²].
/// The layer has no edges.
/// @param cell  sides, mm  @return  rows x columns; the field is even in i and j
/// @throws InputError for a thickness, modulus or ratio that no layer has
Eigen::MatrixXd influence(const ElasticLayer& layer, const Eigen::Vector2d& cell, Eigen::Index rows,
                          Eigen::Index columns);

} // namespace fettle
