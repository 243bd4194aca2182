#pragma once

#include "job/boundary.h"
#include "mesh/mesh.h"
#include "surface/surface.h"

namespace fettle::surface {

/// Square grid over a polygon.
struct SurfaceGrid {
    Eigen::Matrix2Xd xy;        ///< points inside the polygon, row by row, M, mm
    Eigen::Matrix3Xi triangles; ///< counter-clockwise; two for each cell with all four corners inside the polygon
};

inline constexpr double kMaxGridPoints = 2e7; ///< their triangles take half a gigabyte

/// Creates the grid over a polygon.
/// @param outline  in the frame M rotated counter-clockwise by `angle`, mm; the grid is aligned with that frame and
///                 starts at the minimum corner of the polygon's bounding box
/// @param step     mm
/// @throws InputError for more than kMaxGridPoints in the bounding box
SurfaceGrid make_surface_grid(const job::Polygon& outline, double angle, double step);

/// The bounding box of the touches, in M.
/// @throws InputError for a surface without touches
job::Polygon touch_bounding_box(const Surface& surface, const std::string& source);

/// Mesh of the surface over the grid. Triangles with a corner where the surface is not defined are left out.
mesh::Mesh mesh_of(const Surface& surface, const SurfaceGrid& grid);

} // namespace fettle::surface
