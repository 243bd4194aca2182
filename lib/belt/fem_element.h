#pragma once

#include "belt/layer_compliance.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Corners of a hexahedron, mm. Bit k of a corner's number is its side along axis k of the element; the axes are
/// right-handed.
using Hexahedron = Eigen::Matrix<double, 3, 8>;
using HexahedronStiffness = Eigen::Matrix<double, 24, 24>;

/// Stiffness of the trilinear hexahedron, N/mm; degree of freedom 3 i + k is corner i along axis k. The dilatation is
/// the element's mean (B-bar method: Nagtegaal, Parks and Rice 1974; Hughes 1980), so that nearly incompressible rubber
/// imposes one constraint per element and does not lock.
/// @param material  modulus and Poisson's ratio < 0.5; the thickness is not used
HexahedronStiffness stiffness(const Hexahedron& corners, const ElasticLayer& material);

} // namespace fettle::belt
