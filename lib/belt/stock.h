#pragma once

#include "belt/surfel.h"
#include "mesh/shape_file.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Counts of the rays cast on the stock.
struct StockRays {
    Eigen::Index missed = 0;   ///< surfels whose line does not leave the stock within reach: displacement NaN
    Eigen::Index multiple = 0; ///< surfels whose line leaves the stock more than once within reach: the nearest counts
    Eigen::Index flipped_patches = 0; ///< patches whose normals pointed into the stock and were flipped
};

/// Sets each displacement to the signed distance along the normal at which the line leaves the stock; the nearest one
/// if there are several within reach, NaN if there is none. A patch is flipped first if at more than half of its
/// surfels the normals are opposite to those of the nearest stock.
/// @param stock  a mesh, closed or open, or a scan
/// @param reach  max. distance to either side of the design, mm
StockRays cast_rays_on_stock(Surfels& surfels, mesh::MeshOrCloud stock, double reach);

} // namespace fettle::belt
