#pragma once

#include "job/boundary.h"
#include "mesh/mesh.h"
#include "surface/surface.h"

namespace fettle {

/// A square grid over a polygon; its points and the triangles between them.
struct SurfaceGrid {
    Eigen::Matrix2Xd xy;        ///< M, mm; only points in the polygon, row by row
    Eigen::Matrix3Xi triangles; ///< counter-clockwise; two for each cell that has its four corners in the polygon
};

/// @param outline  in a frame that is M turned counter-clockwise by `angle`; the grid is aligned with that frame and
///                 begins at the polygon's least corner
/// @throws InputError if the step makes more than kMostGridPoints
SurfaceGrid grid_over(const Polygon& outline, double angle, double step);
inline constexpr double kMostGridPoints = 2e7; // half a gigabyte of triangles

/// The bounding box of the touches, in M.
/// @throws InputError for a surface without touches
Polygon touched_box(const Surface& surface, const std::string& source);

/// The surface over the grid; triangles with a corner where it is not defined are left out.
Mesh mesh_of(const Surface& surface, const SurfaceGrid& grid);

} // namespace fettle
