#pragma once

#include "belt/surfel.h"
#include "mesh/shape_file.h"

#include <Eigen/Core>

namespace fettle {

/// What casting rays against the stock found.
struct StockRays {
    Eigen::Index missed = 0;         ///< surfels whose line meets no stock within reach: displacement NaN
    Eigen::Index several = 0;        ///< whose line leaves the stock more than once within reach: the nearest counts
    Eigen::Index turned_patches = 0; ///< patches whose normals pointed into the stock, and were turned
};

/// Sets the displacements: where the line along the normal leaves the stock. Of several such places within reach the
/// nearest counts; where it only enters the stock there is none. A patch whose normals look the other way than the
/// stock's nearest to it, at more than half of its surfels, is turned first.
/// @param stock  a mesh, closed or open, or a scan
/// @param reach  both ways, mm
StockRays cast_on_stock(Surfels& surfels, MeshOrCloud stock, double reach);

} // namespace fettle
