#pragma once

#include "belt/layer_compliance.h"

#include <Eigen/Core>

namespace fettle {

/// Corners of a hexahedron, mm: bit 0 of a corner's number says on which side it is along the first of the element's
/// own axes, bit 1 along the second, bit 2 along the third; the axes are right-handed.
using Hexahedron = Eigen::Matrix<double, 3, 8>;
using HexahedronStiffness = Eigen::Matrix<double, 24, 24>;

/// Stiffness of the linear hexahedron, N/mm; displacement 3 i + k is that of corner i along axis k. The change of
/// volume is the element's mean (Nagtegaal, Parks and Rice 1974; Hughes 1980): nearly incompressible rubber costs one
/// constraint an element and does not lock.
/// @param material  its modulus and ratio < 0.5 count
HexahedronStiffness stiffness(const Hexahedron& corners, const ElasticLayer& material);

} // namespace fettle
